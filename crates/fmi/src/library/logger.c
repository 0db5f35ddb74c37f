/* The logger of FMI 2.0 takes its arguments as printf does. Rust can call such functions, not define them: this one turns
   format and arguments into a text and hands it over. */
#include <stdarg.h>
#include <stdio.h>

struct environment {
    void (*hand_over)(const struct environment *, int status, const char *category, const char *text);
};

void servobench_fmi2_logger(const struct environment *environment, const char *instance_name, int status,
                            const char *category, const char *message, ...) {
    char text[4096];
    va_list arguments;
    int length = -1;
    (void)instance_name;
    if (environment == NULL) {
        return;
    }
    if (message != NULL) {
        va_start(arguments, message);
        length = vsnprintf(text, sizeof text, message, arguments);
        va_end(arguments);
    }
    environment->hand_over(environment, status, category, length < 0 ? message : text);
}
