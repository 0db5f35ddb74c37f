/* An FMU of version 2.0 that does what its parameter `mode` says. It logs each call of a transition. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    logger log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} callbacks;
enum { OK, WARNING, DISCARD, ERROR, FATAL, PENDING };
enum { NORMAL, REFUSE, HALF, END, FAIL, DIE, NOT_A_NUMBER, ASYNCHRONOUS, UNKNOWN, FLOOD, COARSE, TELLING, WALL, STRICT, BEYOND };

typedef struct {
    double u, y, du, ddu, reached, longest, stop;
    int mode, flag, steps;
} state;
typedef struct {
    const callbacks *functions;
    char name[100], path[300];
    int has_failed;
    state s;
} instance;

static void note(instance *me, const char *call) {
    me->functions->log(me->functions->environment, me->name, OK, "calls", "%s of %s at %d, %g", call, me->name, me->s.steps, me->s.u);
}

static void farewell(instance *me, const char *call) {
    FILE *file = me->path[0] ? fopen(me->path, "a") : NULL;
    if (file) {
        fprintf(file, "%s\n", call);
        fclose(file);
    }
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const callbacks *functions, int visible,
                      int logging) {
    instance *me;
    if (type != 1 || visible || strncmp(resources, "file:///", 8) || strcmp(resources + strlen(resources) - 10, "/resources")) {
        return NULL;
    }
    if (strcmp(guid, "{two}")) {
        functions->log(functions->environment, name, ERROR, "logStatusError", "the GUID is %s, not %s", guid, "{two}");
        return NULL;
    }
    me = functions->allocate(1, sizeof *me);
    me->functions = functions;
    strncpy(me->name, name, sizeof me->name - 1);
    note(me, logging ? "instantiate, logging" : "instantiate");
    return me;
}
void fmi2FreeInstance(instance *me) {
    farewell(me, "free");
    me->functions->release(me);
}
int fmi2SetupExperiment(instance *me, int has_tolerance, double tolerance, double start, int has_stop, double stop) {
    me->functions->log(me->functions->environment, me->name, OK, "calls", "setup %d %g %g %d %g", has_tolerance, tolerance, start, has_stop, stop);
    me->s.stop = stop;
    return OK;
}
int fmi2EnterInitializationMode(instance *me) { note(me, "enter initialization"); return OK; }
int fmi2ExitInitializationMode(instance *me) { note(me, "exit initialization"); return me->s.mode == FAIL + 100 ? ERROR : OK; }
int fmi2Terminate(instance *me) { farewell(me, "terminate"); return OK; }

int fmi2SetReal(instance *me, const unsigned *vr, size_t n, const double *value) {
    size_t i;
    for (i = 0; i < n; i++) {
        if (vr[i] != 1 && vr[i] != 9) return ERROR;
        *(vr[i] == 1 ? &me->s.u : &me->s.longest) = value[i];
    }
    return OK;
}
int fmi2SetRealInputDerivatives(instance *me, const unsigned *vr, size_t n, const int *order, const double *value) {
    if (n != 1 || vr[0] != 1) return ERROR;
    *(order[0] == 1 ? &me->s.du : &me->s.ddu) = value[0];
    return OK;
}
int fmi2SetInteger(instance *me, const unsigned *vr, size_t n, const int *value) {
    if (n != 1 || vr[0] != 3) return ERROR;
    me->s.mode = value[0];
    return OK;
}
int fmi2SetBoolean(instance *me, const unsigned *vr, size_t n, const int *value) {
    if (n != 1 || vr[0] != 5) return ERROR;
    me->s.flag = value[0];
    return OK;
}
int fmi2SetString(instance *me, const unsigned *vr, size_t n, const char *const *value) {
    if (n != 1 || vr[0] != 4) return ERROR;
    strncpy(me->path, value[0], sizeof me->path - 1);
    return OK;
}
int fmi2GetReal(instance *me, const unsigned *vr, size_t n, double *value) {
    size_t i;
    for (i = 0; i < n; i++) {
        value[i] = vr[i] == 1 ? me->s.u : vr[i] == 2 ? me->s.y : vr[i] == 6 ? me->s.du : me->s.ddu;
        if (me->s.mode == NOT_A_NUMBER && me->s.steps && vr[i] == 2) value[i] = strtod("nan", NULL);
    }
    return OK;
}
int fmi2GetInteger(instance *me, const unsigned *vr, size_t n, int *value) {
    (void)vr;
    return n == 1 ? (value[0] = me->s.steps, OK) : ERROR;
}
int fmi2GetBoolean(instance *me, const unsigned *vr, size_t n, int *value) {
    (void)vr;
    return n == 1 ? (value[0] = me->s.flag ? 7 : 0, OK) : ERROR;
}
int fmi2GetString(void) { return ERROR; }

/* A step that is discarded leaves nonsense. The standard lets nothing but going back follow. */
static int discard(instance *me, double reached) {
    me->has_failed = 1;
    me->s.y = 1e9;
    me->s.reached = reached;
    return DISCARD;
}
/* y' = u, with the derivatives that were set. */
int fmi2DoStep(instance *me, double t, double h, int no_set_prior) {
    (void)no_set_prior;
    if (me->has_failed) return ERROR;
    me->s.steps++;
    switch (me->s.mode) {
    case REFUSE: me->s.reached = t; return DISCARD;
    case HALF: if (h > 0.07) { me->s.reached = t + h / 2; me->s.y += me->s.u * h / 2; return DISCARD; } break;
    case COARSE: if (h > me->s.longest) return discard(me, t); break;
    case TELLING: if (h > me->s.longest) return discard(me, t + me->s.longest); break;
    case WALL: if (t + h > me->s.longest) return discard(me, t); break;
    case END: me->s.reached = t + h / 4; return DISCARD;
    case BEYOND: me->s.reached = t + 2 * h; return DISCARD;
    case STRICT: if (t + h > me->s.stop) return ERROR; break;
    case FAIL: me->functions->log(me->functions->environment, me->name, ERROR, "logStatusError", "no root at %g%%", 100 * t); return ERROR;
    case DIE: return FATAL;
    case ASYNCHRONOUS: return PENDING;
    case UNKNOWN: return 77;
    case FLOOD: for (int i = 0; i < 20000; i++) note(me, "flood"); return WARNING;
    default: break;
    }
    me->s.y += me->s.u * h + me->s.du * h * h / 2 + me->s.ddu * h * h * h / 6;
    return OK;
}
int fmi2GetRealStatus(instance *me, int kind, double *value) { *value = me->s.reached; return kind == 2 ? OK : DISCARD; }
int fmi2GetBooleanStatus(instance *me, int kind, int *value) { *value = me->s.mode == END || me->s.mode == BEYOND; return kind == 3 ? OK : DISCARD; }

int fmi2GetFMUstate(instance *me, void **saved) {
    if (!*saved) *saved = malloc(sizeof(state));
    memcpy(*saved, &me->s, sizeof(state));
    return OK;
}
int fmi2SetFMUstate(instance *me, void *saved) { me->has_failed = 0; memcpy(&me->s, saved, sizeof(state)); return OK; }
int fmi2FreeFMUstate(instance *me, void **saved) { farewell(me, "free state"); free(*saved); *saved = NULL; return OK; }
