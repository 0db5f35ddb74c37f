/* A clock that is set while a program runs: the time of day jumps back and forth by up to a year with every call. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <time.h>

int clock_gettime(clockid_t clock, struct timespec *now) {
    static int (*real)(clockid_t, struct timespec *);
    static unsigned draw = 1;
    int failed;
    if (!real) real = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
    failed = real(clock, now);
    if (!failed && clock == CLOCK_REALTIME) {
        draw = draw * 1103515245u + 12345u;
        now->tv_sec += (long)(draw >> 8) % 63072000 - 31536000;
    }
    return failed;
}
