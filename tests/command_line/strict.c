/* An FMU of version 2.0 that takes the standard at its word. Its state x begins at its input u and stays; y = level + gain*u without a step;
   count and flag count its steps. `mischief` says what it does in the function `where`; in fmi2Instantiate its name says that. */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef void (*logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    logger log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} callbacks;
enum { OK, WARNING, DISCARD, ERROR, FATAL };
enum { NONE = 1, CRASH, HANG, HOARD, FAIL, ESCAPES };
enum { SETUP = 1, ENTER, EXIT, GET, STEP, TERMINATE, FREE };
enum { INSTANTIATED, INITIALIZING, STEPPING };

typedef struct {
    double u, x, level, gain, end, stop, time, echo;
    int mischief, where, count, n, flag, phase;
} state;
typedef struct {
    const callbacks *functions;
    char name[100];
    state s;
} instance;

static int fail(instance *me, const char *why) {
    me->functions->log(me->functions->environment, me->name, ERROR, "logStatusError", "%s", why);
    return ERROR;
}

static int misbehave(instance *me, int mischief) {
    switch (mischief) {
    case CRASH: fprintf(stderr, "strict: no such table\n"); abort();
    case HANG: for (;;) pause();
    case HOARD:
        for (;;) {
            char *block = malloc(1 << 22);
            if (!block) abort();
            memset(block, 1, 1 << 22);
        }
    case FAIL: return fail(me, "the table has no such row");
    case ESCAPES: return fail(me, "\x1b]0;owned\x07\x1b[2J\x1b[31mred\x1b[0m \xef\xbf\xbe\x01\xc2\x9b 7\r8");
    default: return OK;
    }
}

static int at(instance *me, int where) { return me->s.where == where ? misbehave(me, me->s.mischief) : OK; }

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const callbacks *functions, int visible,
                      int logging) {
    instance *me = functions->allocate(1, sizeof *me);
    (void)type, (void)guid, (void)resources, (void)visible, (void)logging;
    me->functions = functions;
    strncpy(me->name, name, sizeof me->name - 1);
    if (!strcmp(name, "crashes")) misbehave(me, CRASH);
    if (!strcmp(name, "hangs")) misbehave(me, HANG);
    if (!strcmp(name, "hoards")) misbehave(me, HOARD);
    return me;
}
void fmi2FreeInstance(instance *me) { at(me, FREE); me->functions->release(me); }
int fmi2SetupExperiment(instance *me, int has_tolerance, double tolerance, double start, int has_stop, double stop) {
    (void)has_tolerance, (void)tolerance;
    me->s.stop = has_stop ? stop : 1e300;
    me->s.time = start;
    me->functions->log(me->functions->environment, me->name, OK, "logEvents", "the stop time is %.17g s", me->s.stop);
    return at(me, SETUP);
}
int fmi2EnterInitializationMode(instance *me) { me->s.phase = INITIALIZING; me->s.x = me->s.u; return at(me, ENTER); }
int fmi2ExitInitializationMode(instance *me) { me->s.phase = STEPPING; return at(me, EXIT); }
int fmi2Terminate(instance *me) { return at(me, TERMINATE); }
int fmi2Reset(instance *me) { (void)me; return ERROR; }

int fmi2SetReal(instance *me, const unsigned *vr, size_t n, const double *value) {
    for (size_t i = 0; i < n; i++) {
        if (vr[i] == 0) {
            me->s.u = value[i];
            if (me->s.phase != STEPPING) me->s.x = value[i];
        } else if (me->s.phase != INSTANTIATED) return fail(me, "a parameter is fixed");
        else if (vr[i] == 3) me->s.level = value[i];
        else if (vr[i] == 4) me->s.gain = value[i];
        else if (vr[i] == 5) me->s.end = value[i];
        else return fail(me, "it is calculated");
    }
    return OK;
}
int fmi2SetInteger(instance *me, const unsigned *vr, size_t n, const int *value) {
    for (size_t i = 0; i < n; i++) *(vr[i] == 0 ? &me->s.mischief : vr[i] == 1 ? &me->s.where : &me->s.n) = value[i];
    return OK;
}
int fmi2SetBoolean(instance *me, const unsigned *vr, size_t n, const int *value) {
    (void)vr;
    for (size_t i = 0; i < n; i++) me->s.flag = value[i];
    return OK;
}
int fmi2SetString(void) { return ERROR; }
int fmi2GetReal(instance *me, const unsigned *vr, size_t n, double *value) {
    if (me->s.phase == INSTANTIATED) return fail(me, "nothing is calculated before the initialization mode");
    for (size_t i = 0; i < n; i++) {
        if (vr[i] == 6 && me->s.phase == INITIALIZING) return fail(me, "a local variable is no unknown of the initialization");
        value[i] = vr[i] == 1 ? me->s.x : vr[i] == 2 ? me->s.level + me->s.gain * me->s.u : vr[i] == 6 ? me->s.time : me->s.echo;
    }
    return at(me, GET);
}
int fmi2GetInteger(instance *me, const unsigned *vr, size_t n, int *value) {
    (void)vr;
    for (size_t i = 0; i < n; i++) value[i] = me->s.count;
    return OK;
}
int fmi2GetBoolean(instance *me, const unsigned *vr, size_t n, int *value) {
    (void)vr;
    for (size_t i = 0; i < n; i++) value[i] = me->s.count % 2;
    return OK;
}
int fmi2GetString(void) { return ERROR; }

int fmi2DoStep(instance *me, double t, double h, int no_set_prior) {
    (void)no_set_prior;
    if (t + h > me->s.stop) return fail(me, "the step goes beyond the stop time");
    if (me->s.end > 0 && t + h >= me->s.end - 1e-12) return DISCARD;
    me->s.time = t + h;
    me->s.count++;
    me->s.echo = me->s.flag + 10.0 * me->s.n;
    return at(me, STEP);
}
int fmi2GetRealStatus(instance *me, int kind, double *value) { *value = me->s.end; return kind == 2 ? OK : DISCARD; }
int fmi2GetBooleanStatus(instance *me, int kind, int *value) { *value = me->s.end > 0; return kind == 3 ? OK : DISCARD; }

int fmi2GetFMUstate(instance *me, void **saved) {
    if (!*saved) *saved = malloc(sizeof(state));
    memcpy(*saved, &me->s, sizeof(state));
    return OK;
}
int fmi2SetFMUstate(instance *me, void *saved) { memcpy(&me->s, saved, sizeof(state)); return OK; }
int fmi2FreeFMUstate(instance *me, void **saved) { (void)me; free(*saved); *saved = NULL; return OK; }
