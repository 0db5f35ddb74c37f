/* A mass that is pushed, m·dv/dt = F, exact for a force that is held over a step. An FMU of FMI 2.0 for co-simulation as a tool
   would make it: the library of the tests, which also does what it should not.

   Variables: 0 force (N), 1 x (mm), 2 v (m/s), 3 mass (kg); integer 0 mischief */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef unsigned int Reference;
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;
typedef struct {
    double force, x, v, mass;
    int mischief;
    const Callbacks *callbacks;
} Mass;
enum { OK, WARNING, DISCARD, ERROR };
enum { NOTHING, CRASH, HANG, HOARD, PRINT, FAIL, NAN_OUTPUT, CRASH_IN_START, SAY_THEN_CRASH, SAY };

#ifdef LINGERS
/* Writes to a file that it leaves open, once more when the process ends. */
static FILE *notes;
static void note(const char *text) { if (notes) fputs(text, notes); }
__attribute__((constructor)) static void begin(void) { if (getenv("MASS_NOTES")) notes = fopen(getenv("MASS_NOTES"), "w"); }
__attribute__((destructor)) static void end(void) { note("destroyed\n"); }
#else
#define note(text)
#endif

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *k) { (void)c, (void)on, (void)n, (void)k; return OK; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const Callbacks *callbacks,
                      int visible, int logging) {
    Mass *m = calloc(1, sizeof *m);
    (void)name, (void)type, (void)guid, (void)resources, (void)visible, (void)logging;
    m->mass = 1.0;
    m->callbacks = callbacks;
    note("instantiated\n");
    return m;
}
void fmi2FreeInstance(void *c) { note("freed\n"); free(c); }
int fmi2SetupExperiment(void *c, int defined, double tolerance, double start, int stops, double stop) {
    (void)c, (void)defined, (void)tolerance, (void)start, (void)stops, (void)stop;
    return OK;
}
int fmi2EnterInitializationMode(void *c) { (void)c; return OK; }
int fmi2ExitInitializationMode(void *c) {
    if (((Mass *)c)->mischief == CRASH_IN_START) *(volatile int *)0 = 1;
    return OK;
}
int fmi2Terminate(void *c) { (void)c; return OK; }
int fmi2Reset(void *c) { (void)c; return OK; }

int fmi2GetReal(void *c, const Reference *r, size_t n, double *y) {
    Mass *m = c;
    double zero = 0.0;
    for (size_t k = 0; k < n; k++) {
        y[k] = r[k] == 0 ? m->force : r[k] == 1 ? 1e3 * m->x : r[k] == 2 ? m->v : m->mass;
        if (m->mischief == NAN_OUTPUT && m->v != 0.0) y[k] = zero / zero;
    }
    return OK;
}
int fmi2SetReal(void *c, const Reference *r, size_t n, const double *u) {
    Mass *m = c;
    for (size_t k = 0; k < n; k++) {
        if (r[k] == 0) m->force = u[k];
        if (r[k] == 1) m->x = 1e-3 * u[k];
        if (r[k] == 3) m->mass = u[k];
    }
    return OK;
}
int fmi2GetInteger(void *c, const Reference *r, size_t n, int *y) {
    for (size_t k = 0; k < n; k++) y[k] = ((Mass *)c)->mischief;
    (void)r;
    return OK;
}
int fmi2SetInteger(void *c, const Reference *r, size_t n, const int *u) {
    for (size_t k = 0; k < n; k++) ((Mass *)c)->mischief = u[k];
    (void)r;
    return OK;
}
int fmi2GetBoolean(void *c, const Reference *r, size_t n, int *y) { (void)c, (void)r, (void)n, (void)y; return ERROR; }
int fmi2SetBoolean(void *c, const Reference *r, size_t n, const int *u) { (void)c, (void)r, (void)n, (void)u; return ERROR; }
int fmi2GetString(void *c, const Reference *r, size_t n, const char **y) { (void)c, (void)r, (void)n, (void)y; return ERROR; }
int fmi2SetString(void *c, const Reference *r, size_t n, const char *const *u) { (void)c, (void)r, (void)n, (void)u; return ERROR; }

int fmi2DoStep(void *c, double time, double h, int keeps) {
    Mass *m = c;
    (void)keeps;
    if (time > 0.0) {
        switch (m->mischief) {
        case SAY_THEN_CRASH:
            m->callbacks->logger(m->callbacks->environment, "mass", WARNING, "logStatusWarning", "the mass is %g kg", m->mass);
            /* falls through */
        case CRASH:
            *(volatile int *)0 = 1;
            break;
        case HANG:
            for (;;) {
            }
        case HOARD:
            for (;;) memset(malloc(1 << 20), 1, 1 << 20);
        case PRINT:
            for (int k = 0; k < 100000; k++) printf("%0100d\n", k);
            break;
        case SAY:
            m->callbacks->logger(m->callbacks->environment, "mass", OK, "logEvents", "at %g s", time);
            break;
        case FAIL:
            m->callbacks->logger(m->callbacks->environment, "mass", ERROR, "logStatusError", "the mass is %g kg", m->mass);
            return ERROR;
        }
    }
    double a = m->force / m->mass;
    m->x += h * (m->v + 0.5 * h * a);
    m->v += h * a;
    return OK;
}
