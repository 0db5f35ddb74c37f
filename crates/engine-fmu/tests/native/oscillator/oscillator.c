/* Two masses with a spring and a damper between them, split by force and displacement: two FMUs of FMI 2.0 for co-simulation,
   as a tool would make them. Variables have the references of the enumerations; all are in SI units.

   mass                m*dv/dt = F(t) + f, F = amplitude*(1 - cos wt)^2
   spring (SPRING)     m*dv/dt = -f,       f = -c*(x1 - x) - d*(v1 - v)

   Inputs are parabolas over a step if they are given derivatives, else they are held. The mass integrates them in closed form,
   the spring by its Taylor series: 40 terms, exact to rounding for steps up to about 4/sqrt(c/m). */
#include <math.h>
#include <stdlib.h>

#ifdef SPRING
enum { X1, V1, F, X, V, M, C, D, COUNT };
#else
enum { F, X, V, M, AMPLITUDE, W, COUNT };
#endif
enum { OK, WARNING, DISCARD, ERROR };

typedef unsigned int Reference;
typedef struct {
    /* Of inputs the first two derivatives for the step that comes. */
    double value[COUNT], slope[COUNT], bend[COUNT];
} Model;

#ifdef SPRING
static void output(Model *m) {
    double *p = m->value;
    p[F] = -p[C] * (p[X1] - p[X]) - p[D] * (p[V1] - p[V]);
}
static void integrate(Model *m, double time, double h) {
    double *p = m->value, x = p[X], v = p[V];
    (void)time;
    for (int k = 0; k < 40; k++) {
        /* Of each its term k of the series, times h^k. */
        double x1 = k == 0 ? p[X1] : k == 1 ? h * m->slope[X1] : k == 2 ? 0.5 * h * h * m->bend[X1] : 0.0;
        double v1 = k == 0 ? p[V1] : k == 1 ? h * m->slope[V1] : k == 2 ? 0.5 * h * h * m->bend[V1] : 0.0;
        double a = (p[C] * (x1 - x) + p[D] * (v1 - v)) / p[M];
        x = h * v / (k + 1);
        v = h * a / (k + 1);
        p[X] += x;
        p[V] += v;
    }
}
#else
static void output(Model *m) { (void)m; }
/* Velocity and position that F alone gives a mass of 1 kg from rest at time 0. */
static double driven_v(const double *p, double t) {
    return p[AMPLITUDE] * (1.5 * t - 2.0 * sin(p[W] * t) / p[W] + 0.25 * sin(2.0 * p[W] * t) / p[W]);
}
static double driven_x(const double *p, double t) {
    double w = p[W];
    return p[AMPLITUDE] * (0.75 * t * t + (2.0 * (cos(w * t) - 1.0) - 0.125 * (cos(2.0 * w * t) - 1.0)) / (w * w));
}
static void integrate(Model *m, double t, double h) {
    double *p = m->value, f = p[F], slope = m->slope[F], bend = m->bend[F];
    double by_force = driven_x(p, t + h) - driven_x(p, t) - h * driven_v(p, t);
    p[X] += h * p[V] + (by_force + h * h * (f / 2.0 + h * (slope / 6.0 + h * bend / 24.0))) / p[M];
    p[V] += (driven_v(p, t + h) - driven_v(p, t) + h * (f + h * (slope / 2.0 + h * bend / 6.0))) / p[M];
}
#endif

int fmi2DoStep(void *c, double time, double h, int keeps) {
    Model *m = c;
    (void)keeps;
    integrate(m, time, h);
    for (int r = 0; r < COUNT; r++) {
        m->value[r] += h * (m->slope[r] + 0.5 * h * m->bend[r]);
        m->slope[r] = m->bend[r] = 0.0;
    }
    return OK;
}
int fmi2GetReal(void *c, const Reference *r, size_t n, double *y) {
    output(c);
    for (size_t k = 0; k < n; k++) y[k] = ((Model *)c)->value[r[k]];
    return OK;
}
int fmi2SetReal(void *c, const Reference *r, size_t n, const double *u) {
    for (size_t k = 0; k < n; k++) ((Model *)c)->value[r[k]] = u[k];
    return OK;
}
int fmi2SetRealInputDerivatives(void *c, const Reference *r, size_t n, const int *orders, const double *u) {
    Model *m = c;
    for (size_t k = 0; k < n; k++) (orders[k] == 1 ? m->slope : m->bend)[r[k]] = u[k];
    return OK;
}
int fmi2GetFMUstate(void *c, void **state) {
    if (!*state) *state = malloc(sizeof(Model));
    *(Model *)*state = *(Model *)c;
    return OK;
}
int fmi2SetFMUstate(void *c, void *state) {
    *(Model *)c = *(Model *)state;
    return OK;
}
int fmi2FreeFMUstate(void *c, void **state) {
    (void)c;
    free(*state);
    *state = NULL;
    return OK;
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *k) { (void)c, (void)on, (void)n, (void)k; return OK; }
void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *callbacks, int visible,
                      int logging) {
    (void)name, (void)type, (void)guid, (void)resources, (void)callbacks, (void)visible, (void)logging;
    return calloc(1, sizeof(Model));
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

/* It has no variables of other types. */
int fmi2GetInteger(void *c, const Reference *r, size_t n, int *y) { (void)c, (void)r, (void)n, (void)y; return ERROR; }
int fmi2SetInteger(void *c, const Reference *r, size_t n, const int *u) { (void)c, (void)r, (void)n, (void)u; return ERROR; }
int fmi2GetBoolean(void *c, const Reference *r, size_t n, int *y) { (void)c, (void)r, (void)n, (void)y; return ERROR; }
int fmi2SetBoolean(void *c, const Reference *r, size_t n, const int *u) { (void)c, (void)r, (void)n, (void)u; return ERROR; }
int fmi2GetString(void *c, const Reference *r, size_t n, const char **y) { (void)c, (void)r, (void)n, (void)y; return ERROR; }
int fmi2SetString(void *c, const Reference *r, size_t n, const char *const *u) { (void)c, (void)r, (void)n, (void)u; return ERROR; }
