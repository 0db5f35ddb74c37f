/* An FMU of version 3.0 with the event mode. It returns early at 0.25 s, where two updates are needed; `mode` says what else.
   With a `period` it has events at `first`, `first` + `period` and so on instead, which it announces, and y' is their number. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*logger)(void *, int, const char *, const char *);
enum { OK, WARNING, DISCARD, ERROR, FATAL };
enum { NORMAL, END, CIRCLE, FAIL, DIE, REFUSE, END_AT_START, COARSE, AT_NAN, BEYOND, BEFORE, AT_END, AT_START, END_AT_NAN };

typedef struct {
    double u, y, array[8], time, first, period;
    float small;
    int32_t d, mode;
    uint64_t events, n;
    bool flag;
    int pending, ticks;
} state;
typedef struct {
    void *environment;
    logger log;
    char path[300];
    bool is_stepping, has_configured, event_mode;
    state s;
} instance;

static void farewell(instance *me, const char *call) {
    FILE *file = me->path[0] ? fopen(me->path, "a") : NULL;
    if (file) {
        fprintf(file, "%s\n", call);
        fclose(file);
    }
}
static int said(instance *me, int status, const char *text) { me->log(me->environment, status, "calls", text); return status; }

const char *fmi3GetVersion(void) { return "3.0.2"; }
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging, bool event_mode,
                                  bool early_return, const uint32_t *required, size_t n_required, void *environment, logger log, void *update) {
    instance *me = calloc(1, sizeof *me);
    (void)name, (void)logging, (void)required;
    if (strcmp(token, "{three}") || visible || !early_return || n_required || update || resources) {
        log(environment, ERROR, "logStatusError", "not what was agreed");
        return NULL;
    }
    me->event_mode = event_mode;
    me->environment = environment, me->log = log, me->s.n = 3;
    for (int i = 0; i < 8; i++) me->s.array[i] = i + 1;
    said(me, OK, "instantiate");
    return me;
}
void fmi3FreeInstance(instance *me) { farewell(me, "free"); free(me); }
int fmi3EnterConfigurationMode(instance *me) { me->has_configured = true; return said(me, OK, "enter configuration"); }
int fmi3ExitConfigurationMode(instance *me) { return said(me, OK, "exit configuration"); }
int fmi3EnterInitializationMode(instance *me, bool has_tolerance, double tolerance, double start, bool has_stop, double stop) {
    char text[100];
    snprintf(text, sizeof text, "enter initialization %d %g %g %d %g", has_tolerance, tolerance, start, has_stop, stop);
    return said(me, OK, text);
}
int fmi3ExitInitializationMode(instance *me) { me->is_stepping = !me->event_mode; return said(me, OK, "exit initialization"); }
int fmi3EnterEventMode(instance *me) { if (!me->event_mode) return ERROR; me->is_stepping = false; return said(me, OK, "enter event"); }
int fmi3EnterStepMode(instance *me) { me->is_stepping = true; return said(me, OK, "enter step"); }
int fmi3Terminate(instance *me) { farewell(me, "terminate"); return OK; }
int fmi3UpdateDiscreteStates(instance *me, bool *again, bool *end, bool *nominals, bool *values, bool *has_next, double *next) {
    *nominals = *values = *has_next = false, *next = 0;
    *end = me->s.mode == END_AT_START;
    *again = me->s.mode == CIRCLE || me->s.pending > 1;
    if (me->s.pending) me->s.pending--;
    me->s.events++;
    if (me->s.period > 0) {
        while (me->s.time >= me->s.first + me->s.ticks * me->s.period) me->s.ticks++;
        *has_next = true, *next = me->s.first + me->s.ticks * me->s.period;
    }
    return said(me, OK, "update");
}

int fmi3SetFloat64(instance *me, const uint32_t *vr, size_t n, const double *values, size_t n_values) {
    const double *end = values + n_values;
    for (size_t i = 0; i < n; i++) {
        if (vr[i] == 1) me->s.u = *values++;
        else if (vr[i] == 12) me->s.first = *values++;
        else if (vr[i] == 13) me->s.period = *values++;
        else if (vr[i] == 5) for (uint64_t k = 0; k < me->s.n; k++) me->s.array[k] = *values++;
        else return ERROR;
    }
    return values == end ? OK : said(me, ERROR, "the number of values is wrong");
}
int fmi3GetFloat64(instance *me, const uint32_t *vr, size_t n, double *values, size_t n_values) {
    double *end = values + n_values;
    for (size_t i = 0; i < n; i++) {
        if (vr[i] == 5) for (uint64_t k = 0; k < me->s.n; k++) *values++ = me->s.array[k];
        else if (vr[i] == 6) { double sum = 0; for (uint64_t k = 0; k < me->s.n; k++) sum += me->s.array[k]; *values++ = sum; }
        else *values++ = vr[i] == 1 ? me->s.u : me->s.y;
    }
    return values == end ? OK : said(me, ERROR, "the number of values is wrong");
}
/* In the step mode what changes at events cannot be set. */
int fmi3SetInt32(instance *me, const uint32_t *vr, size_t n, const int32_t *values, size_t n_values) {
    if (n != 1 || n_values != 1 || (me->is_stepping && me->event_mode)) return said(me, ERROR, "set in the wrong mode");
    *(vr[0] == 2 ? &me->s.d : &me->s.mode) = values[0];
    return OK;
}
int fmi3GetInt32(instance *me, const uint32_t *vr, size_t n, int32_t *values, size_t n_values) {
    (void)vr, (void)n, (void)n_values;
    values[0] = me->s.d;
    return OK;
}
int fmi3SetUInt64(instance *me, const uint32_t *vr, size_t n, const uint64_t *values, size_t n_values) {
    if (n != 1 || n_values != 1 || vr[0] != 8 || !me->has_configured) return ERROR;
    me->s.n = values[0];
    return OK;
}
int fmi3GetUInt64(instance *me, const uint32_t *vr, size_t n, uint64_t *values, size_t n_values) {
    (void)n, (void)n_values;
    values[0] = vr[0] == 8 ? me->s.n : me->s.events;
    return OK;
}
int fmi3SetString(instance *me, const uint32_t *vr, size_t n, const char *const *values, size_t n_values) {
    if (n != 1 || n_values != 1 || vr[0] != 9) return ERROR;
    strncpy(me->path, values[0], sizeof me->path - 1);
    return OK;
}
int fmi3SetFloat32(instance *me, const uint32_t *vr, size_t n, const float *values, size_t n_values) {
    (void)vr;
    return n == 1 && n_values == 1 ? (me->s.small = values[0], OK) : ERROR;
}
int fmi3GetFloat32(instance *me, const uint32_t *vr, size_t n, float *values, size_t n_values) {
    (void)vr;
    return n == 1 && n_values == 1 ? (values[0] = me->s.small, OK) : ERROR;
}
int fmi3SetBoolean(instance *me, const uint32_t *vr, size_t n, const bool *values, size_t n_values) {
    (void)vr;
    return n == 1 && n_values == 1 && !me->is_stepping ? (me->s.flag = values[0], OK) : ERROR;
}
int fmi3GetBoolean(instance *me, const uint32_t *vr, size_t n, bool *values, size_t n_values) {
    (void)vr, (void)n, (void)n_values;
    memset(values, me->s.flag ? 2 : 0, 1);
    return OK;
}
#define NONE(name) int name(void) { return ERROR; }
NONE(fmi3GetInt8) NONE(fmi3GetUInt8) NONE(fmi3GetInt16) NONE(fmi3GetUInt16) NONE(fmi3GetUInt32) NONE(fmi3GetInt64)
NONE(fmi3SetInt8) NONE(fmi3SetUInt8) NONE(fmi3SetInt16) NONE(fmi3SetUInt16) NONE(fmi3SetUInt32) NONE(fmi3SetInt64) NONE(fmi3SetBinary)

int fmi3DoStep(instance *me, double t, double h, bool no_set_prior, bool *event, bool *end, bool *early, double *last) {
    double to = t + h;
    (void)no_set_prior;
    *event = *end = *early = false;
    if (!me->is_stepping) return said(me, ERROR, "a step in the wrong mode");
    if (me->s.mode == FAIL) return said(me, ERROR, "no root\n");
    if (me->s.mode == DIE) return FATAL;
    if (me->s.mode == REFUSE) return DISCARD;
    if (me->s.mode >= AT_NAN) {
        *early = me->s.mode != END_AT_NAN, *end = me->s.mode == END_AT_NAN;
        *last = me->s.mode == BEYOND ? t + 2 * h : me->s.mode == BEFORE ? t - h : me->s.mode == AT_END ? t + h : me->s.mode == AT_START ? t : strtod("nan", NULL);
        return OK;
    }
    if (me->s.mode == COARSE) {
        *last = t;
        if (h > 0.3) return DISCARD;
        me->s.y += me->s.d * h;
    }
    if (me->s.period > 0) me->s.u = me->s.ticks;
    else if (me->s.mode != COARSE && t < 0.25 && to >= 0.25) to = 0.25, *event = true, *early = to < t + h, me->s.pending = 2;
    if (me->s.mode == END && to > 0.5) to = 0.5, *end = true;
    me->s.y += me->s.u * (to - t);
    *last = me->s.time = to;
    return OK;
}
int fmi3GetFMUState(instance *me, void **saved) {
    if (!*saved) *saved = malloc(sizeof(state));
    memcpy(*saved, &me->s, sizeof(state));
    return OK;
}
int fmi3SetFMUState(instance *me, void *saved) { memcpy(&me->s, saved, sizeof(state)); return OK; }
int fmi3FreeFMUState(instance *me, void **saved) { farewell(me, "free state"); free(*saved); *saved = NULL; return OK; }
