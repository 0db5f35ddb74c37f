/* A mass on a spring that hangs on somebody else's body, m·dv₂/dt = −F with F = c·(x₂ − x) + d·(v₂ − v), and a mass that is pushed,
   m·dv/dt = f. An FMU of FMI 2.0 for co-simulation as a tool would make it: the library of the tests, which also does what it should
   not, from 0.1 s on.

   Reals: 0 x (m), 1 v (m/s), 2 force F (N); 3 effort f (N), 4 position (m), 5 velocity (m/s); 6 mass (kg), 7 stiffness c (N/m),
   8 damping d (N s/m). Enumeration: 0 mischief. */
#include <math.h>
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
enum { X, V, FORCE, EFFORT, POSITION, VELOCITY, MASS, STIFFNESS, DAMPING, REALS };
typedef struct {
    double real[REALS];
    double hung_x, hung_v; /* the hanging mass */
    double time;
    int mischief, has_flooded;
    const Callbacks *callbacks;
} Attached;
enum { OK, WARNING, DISCARD, ERROR, FATAL };
enum { NONE = 1, CRASH, HANG, HOARD, PRINT, LOG, EXIT, NAN_OUTPUT, FAIL, FAIL_FOR_GOOD, REFUSE, END,
       ABORT, OVERFLOW };
enum { BLOCK = 1 << 16, BLOCKS = 1 << 14 }; /* a gibibyte */

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *k) { (void)c, (void)on, (void)n, (void)k; return OK; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const Callbacks *callbacks,
                      int visible, int logging) {
    Attached *a = calloc(1, sizeof *a);
    (void)name, (void)type, (void)guid, (void)resources, (void)visible, (void)logging;
    a->real[MASS] = 1.0;
    a->real[STIFFNESS] = 1e4;
    a->real[DAMPING] = 10.0;
    a->mischief = NONE;
    a->callbacks = callbacks;
    return a;
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetupExperiment(void *c, int defined, double tolerance, double start, int stops, double stop) {
    (void)c, (void)defined, (void)tolerance, (void)start, (void)stops, (void)stop;
    return OK;
}
int fmi2EnterInitializationMode(void *c) { (void)c; return OK; }
int fmi2ExitInitializationMode(void *c) { (void)c; return OK; }
int fmi2Terminate(void *c) { (void)c; return OK; }
int fmi2Reset(void *c) { (void)c; return OK; }

static double force(const Attached *a) {
    return a->real[STIFFNESS] * (a->hung_x - a->real[X]) + a->real[DAMPING] * (a->hung_v - a->real[V]);
}

int fmi2GetReal(void *c, const Reference *r, size_t n, double *y) {
    Attached *a = c;
    int is_late = a->mischief == NAN_OUTPUT && a->time > 0.1;
    a->real[FORCE] = force(a);
    for (size_t k = 0; k < n; k++) y[k] = is_late ? NAN : a->real[r[k]];
    return OK;
}
int fmi2SetReal(void *c, const Reference *r, size_t n, const double *u) {
    for (size_t k = 0; k < n; k++) ((Attached *)c)->real[r[k]] = u[k];
    return OK;
}
int fmi2GetInteger(void *c, const Reference *r, size_t n, int *y) {
    for (size_t k = 0; k < n; k++) y[k] = ((Attached *)c)->mischief;
    (void)r;
    return OK;
}
int fmi2SetInteger(void *c, const Reference *r, size_t n, const int *u) {
    for (size_t k = 0; k < n; k++) ((Attached *)c)->mischief = u[k];
    (void)r;
    return OK;
}
int fmi2GetBoolean(void *c, const Reference *r, size_t n, int *y) { (void)c, (void)r, (void)n, (void)y; return ERROR; }
int fmi2SetBoolean(void *c, const Reference *r, size_t n, const int *u) { (void)c, (void)r, (void)n, (void)u; return ERROR; }
int fmi2GetString(void *c, const Reference *r, size_t n, const char **y) { (void)c, (void)r, (void)n, (void)y; return ERROR; }
int fmi2SetString(void *c, const Reference *r, size_t n, const char *const *u) { (void)c, (void)r, (void)n, (void)u; return ERROR; }

int fmi2GetFMUstate(void *c, void **state) {
    if (!*state) *state = malloc(sizeof(Attached));
    memcpy(*state, c, sizeof(Attached));
    return OK;
}
int fmi2SetFMUstate(void *c, void *state) { memcpy(c, state, sizeof(Attached)); return OK; }
int fmi2FreeFMUstate(void *c, void **state) { (void)c; free(*state); *state = NULL; return OK; }

/* What became of a step that was discarded: 2 asks for the last time that was reached, 3 whether all is to end. */
int fmi2GetRealStatus(void *c, int kind, double *value) {
    if (kind != 2) return DISCARD;
    *value = ((Attached *)c)->time;
    return OK;
}
int fmi2GetBooleanStatus(void *c, int kind, int *value) {
    if (kind != 3) return DISCARD;
    *value = ((Attached *)c)->mischief == END;
    return OK;
}

static void flood(Attached *a) {
    static char block[BLOCK];
    if (a->has_flooded) return;
    a->has_flooded = 1;
    memset(block, 'x', sizeof block - 1);
    for (int k = 0; k < BLOCKS; k++) {
        if (a->mischief == PRINT) fwrite(block, 1, sizeof block - 1, stdout);
        else a->callbacks->logger(a->callbacks->environment, "attached", OK, "logAll", "%s", block);
    }
}

/* Until there is no stack left. */
static int overflow(int depth) {
    volatile char frame[4096];
    frame[0] = (char)depth;
    return overflow(depth + 1) + frame[0];
}

int fmi2DoStep(void *c, double time, double h, int keeps) {
    enum { PARTS = 16 };
    Attached *a = c;
    /* What a drill asks for, whatever the parameter says. */
    const char *asked = getenv("ATTACHED_MISCHIEF");
    (void)keeps;
    if (time >= 0.1 && asked) a->mischief = atoi(asked);
    if (time >= 0.1) {
        switch (a->mischief) {
        case CRASH:
            *(volatile int *)0 = 1;
            break;
        case HANG:
            for (;;) {
            }
        case HOARD:
            for (;;) memset(malloc(1 << 20), 1, 1 << 20);
        case PRINT:
        case LOG:
            flood(a);
            break;
        case ABORT:
            abort();
        case OVERFLOW:
            overflow(0);
            break;
        case EXIT:
            fputs("attached: the licence has expired\n", stderr);
            exit(7);
        case FAIL:
        case FAIL_FOR_GOOD:
            a->callbacks->logger(a->callbacks->environment, "attached", ERROR, "logStatusError", "the spring of %g N/m broke",
                                 a->real[STIFFNESS]);
            return a->mischief == FAIL ? ERROR : FATAL;
        case REFUSE:
        case END:
            return DISCARD;
        }
    }
    /* Velocity Verlet with parts that are short beside any period of these tests. */
    double part = h / PARTS, mass = a->real[MASS];
    for (int k = 0; k < PARTS; k++) {
        a->hung_v -= 0.5 * part * force(a) / mass;
        a->hung_x += part * a->hung_v;
        a->hung_v -= 0.5 * part * force(a) / mass;
    }
    double acceleration = a->real[EFFORT] / mass;
    a->real[POSITION] += h * (a->real[VELOCITY] + 0.5 * h * acceleration);
    a->real[VELOCITY] += h * acceleration;
    a->time = time + h;
    return OK;
}
