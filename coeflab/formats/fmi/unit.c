/* FMI 2.0, model exchange and co-simulation, of @NAME@: one vehicle in water at rest under its own law.
   Written from the standard, Functional Mock-up Interface 2.0 (2014); needs no header of it. */
#include "@NAME@.c"
#include <stdlib.h>
#include <string.h>

#if defined _WIN32 || defined __CYGWIN__
#define EXPORT __declspec(dllexport)
#elif defined __GNUC__
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef struct {
    void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;
typedef struct {
    fmi2Boolean newDiscreteStatesNeeded, terminateSimulation, nominalsOfContinuousStatesChanged, valuesOfContinuousStatesChanged, nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

/* Thrusters are states where one of them has a lag. */
#define SPINS @SPINS@
/* References: parameters, inputs, states, their derivatives, other outputs. */
#define STARTS 13
#define TERMS COEFFICIENTS
#define INPUTS (9 + 2 * THRUSTERS)
#define STATES (16 + SPINS)
#define OTHERS 9
#define AT_TERMS STARTS
#define AT_INPUTS (AT_TERMS + TERMS)
#define AT_STATES (AT_INPUTS + INPUTS)
#define AT_RATES (AT_STATES + STATES)
#define AT_OTHERS (AT_RATES + STATES)
#define REFERENCES (AT_OTHERS + OTHERS)

static const double START[STARTS] = {@START@};
/* SI value of one unit of a coefficient's parameter */
static const double UNIT[TERMS + 1] = {@UNIT@};
static const double GIVEN[TERMS + 1] = {@GIVEN@};
/* time in which a fin with a rate comes to its order in model exchange, s */
#define SOON 0.005

typedef struct {
    double start[STARTS], value[TERMS + 1], input[INPUTS], state[STATES], time;
    int begun, status;
} unit;

typedef struct {
    unit u;
    void (*release)(void *);
} instance;

static void restart(unit *u)
{
    int i;
    for (i = 0; i < STARTS; i++) u->start[i] = START[i];
    for (i = 0; i < TERMS; i++) u->value[i] = GIVEN[i];
    for (i = 0; i < INPUTS; i++) u->input[i] = 0.0;
    u->time = 0.0, u->begun = 0, u->status = 0;
}

static void begin(unit *u)
{
    const double *s = u->start;
    const double cr = cos(s[3] / 2), sr = sin(s[3] / 2), cp = cos(s[4] / 2), sp = sin(s[4] / 2), cy = cos(s[5] / 2), sy = sin(s[5] / 2);
    int i;
    for (i = 0; i < 3; i++) u->state[i] = s[i];
    u->state[3] = cr * cp * cy + sr * sp * sy;
    u->state[4] = sr * cp * cy - cr * sp * sy;
    u->state[5] = cr * sp * cy + sr * cp * sy;
    u->state[6] = cr * cp * sy - sr * sp * cy;
    for (i = 0; i < 6; i++) u->state[7 + i] = s[6 + i];
    for (i = 0; i < 3; i++) u->state[13 + i] = TURNS[i] > 0.0 ? 0.0 : turned(i, 0.0, u->input[i], 0.0);
    for (i = 0; i < SPINS; i++) u->state[16 + i] = u->input[9 + i];
}

static void coefficients(const unit *u, double *c)
{
    int i;
    for (i = 0; i < (int) (sizeof VALUES / sizeof VALUES[0]); i++) c[i] = i < TERMS ? u->value[i] * UNIT[i] : VALUES[i];
}

static double spin(const unit *u, int i) { return LAG[i] > 0.0 ? u->state[16 + i] : u->input[9 + i]; }

static void pushed(const unit *u, double external[6])
{
    double thrust[6], actual[THRUSTERS + 1];
    int i;
    for (i = 0; i < THRUSTERS; i++) actual[i] = SPINS ? spin(u, i) : u->input[9 + i];
    @NAME@_thrust(actual, u->input + 9 + THRUSTERS, thrust);
    for (i = 0; i < 6; i++) external[i] = thrust[i] + u->input[3 + i];
}

static double fin(const unit *u, int i) { return TURNS[i] > 0.0 ? u->state[13 + i] : u->input[i]; }

static int derive(const unit *u, double rates[STATES])
{
    double c[sizeof VALUES / sizeof VALUES[0]], external[6], delta[3];
    int i;
    coefficients(u, c);
    pushed(u, external);
    for (i = 0; i < 3; i++) {
        delta[i] = fin(u, i);
        rates[13 + i] = TURNS[i] > 0.0 ? at_most((at_most(u->input[i], -LIMIT[i], LIMIT[i]) - delta[i]) / SOON, -TURNS[i], TURNS[i]) : 0.0;
    }
    for (i = 0; i < SPINS; i++) rates[16 + i] = LAG[i] > 0.0 ? (u->input[9 + i] - u->state[16 + i]) / LAG[i] : 0.0;
    return rates_of(c, u->state, delta, external, rates);
}

static double value_of(unit *u, fmi2ValueReference r)
{
    if (r < AT_TERMS) return u->start[r];
    if (r < AT_INPUTS) return u->value[r - AT_TERMS];
    if (r < AT_STATES) return u->input[r - AT_INPUTS];
    if (r < AT_RATES && r >= AT_STATES + 16) return spin(u, (int) (r - AT_STATES - 16));
    if (r < AT_RATES) return r >= AT_STATES + 13 ? turned((int) (r - AT_STATES - 13), 0.0, fin(u, (int) (r - AT_STATES - 13)), 1e300) : u->state[r - AT_STATES];
    if (r < AT_OTHERS) {
        double rates[STATES];
        u->status = derive(u, rates);
        return rates[r - AT_RATES];
    }
    if (r < AT_OTHERS + 3) {
        const double *q = u->state + 3;
        if (r == AT_OTHERS) return atan2(2 * (q[0] * q[1] + q[2] * q[3]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
        if (r == AT_OTHERS + 1) return asin(at_most(2 * (q[0] * q[2] - q[3] * q[1]), -1, 1));
        return atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    } else {
        double c[sizeof VALUES / sizeof VALUES[0]], force[6], delta[3];
        int i;
        coefficients(u, c);
        for (i = 0; i < 3; i++) delta[i] = fin(u, i);
        u->status = force_of(c, u->state + 7, delta, force);
        return force[r - AT_OTHERS - 3];
    }
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[])
{
    (void) c, (void) on, (void) n, (void) names;
    return fmi2OK;
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String place, const fmi2CallbackFunctions *f, fmi2Boolean visible, fmi2Boolean on)
{
    instance *made;
    (void) name, (void) type, (void) place, (void) visible, (void) on;
    if (!guid || strcmp(guid, "@GUID@") != 0) return NULL;
    made = (instance *) (f && f->allocateMemory ? f->allocateMemory(1, sizeof(instance)) : calloc(1, sizeof(instance)));
    if (!made) return NULL;
    made->release = f && f->freeMemory ? f->freeMemory : free;
    restart(&made->u);
    begin(&made->u);
    return made;
}

EXPORT void fmi2FreeInstance(fmi2Component c)
{
    if (c) ((instance *) c)->release(c);
}

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean known, fmi2Real tolerance, fmi2Real start, fmi2Boolean ends, fmi2Real stop)
{
    (void) known, (void) tolerance, (void) ends, (void) stop;
    ((unit *) c)->time = start;
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    begin((unit *) c);
    return fmi2OK;
}

EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    begin((unit *) c);
    ((unit *) c)->begun = 1;
    return fmi2OK;
}

EXPORT fmi2Status fmi2Terminate(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

EXPORT fmi2Status fmi2Reset(fmi2Component c)
{
    restart((unit *) c);
    begin((unit *) c);
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real x[])
{
    unit *u = (unit *) c;
    size_t i;
    u->status = 0;
    for (i = 0; i < n; i++) {
        if (r[i] >= REFERENCES) return fmi2Error;
        x[i] = value_of(u, r[i]);
    }
    return u->status ? fmi2Discard : fmi2OK;
}

EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real x[])
{
    unit *u = (unit *) c;
    size_t i;
    for (i = 0; i < n; i++) {
        if (r[i] < AT_TERMS) u->start[r[i]] = x[i];
        else if (r[i] < AT_INPUTS) u->value[r[i] - AT_TERMS] = x[i];
        else if (r[i] < AT_STATES) u->input[r[i] - AT_INPUTS] = x[i];
        else return fmi2Error;
        if (!u->begun) begin(u);
    }
    return fmi2OK;
}

#define NO_OTHER(kind, type) \
    EXPORT fmi2Status fmi2Get##kind(fmi2Component c, const fmi2ValueReference r[], size_t n, type x[]) \
    { \
        (void) c, (void) r, (void) x; \
        return n ? fmi2Error : fmi2OK; \
    } \
    EXPORT fmi2Status fmi2Set##kind(fmi2Component c, const fmi2ValueReference r[], size_t n, const type x[]) \
    { \
        (void) c, (void) r, (void) x; \
        return n ? fmi2Error : fmi2OK; \
    }
NO_OTHER(Integer, fmi2Integer)
NO_OTHER(Boolean, fmi2Boolean)
NO_OTHER(String, fmi2String)

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *s)
{
    if (!*s) *s = malloc(sizeof(unit));
    if (!*s) return fmi2Error;
    memcpy(*s, c, sizeof(unit));
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate s)
{
    memcpy(c, s, sizeof(unit));
    return fmi2OK;
}

EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *s)
{
    (void) c;
    free(*s);
    *s = NULL;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate s, size_t *n)
{
    (void) c, (void) s;
    *n = sizeof(unit);
    return fmi2OK;
}

EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate s, fmi2Byte b[], size_t n)
{
    (void) c;
    if (n < sizeof(unit)) return fmi2Error;
    memcpy(b, s, sizeof(unit));
    return fmi2OK;
}

EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte b[], size_t n, fmi2FMUstate *s)
{
    if (n < sizeof(unit) || fmi2GetFMUstate(c, s) != fmi2OK) return fmi2Error;
    memcpy(*s, b, sizeof(unit));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference z[], size_t nz, const fmi2ValueReference v[], size_t nv, const fmi2Real dv[], fmi2Real dz[])
{
    (void) c, (void) z, (void) nz, (void) v, (void) nv, (void) dv, (void) dz;
    return fmi2Error;
}

EXPORT fmi2Status fmi2EnterEventMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }
EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }
EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *e)
{
    (void) c;
    memset(e, 0, sizeof *e);
    return fmi2OK;
}

EXPORT fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean no_set, fmi2Boolean *event, fmi2Boolean *end)
{
    (void) c, (void) no_set;
    *event = *end = 0;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    ((unit *) c)->time = time;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n)
{
    if (n != STATES) return fmi2Error;
    memcpy(((unit *) c)->state, x, STATES * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real x[], size_t n)
{
    if (n != STATES) return fmi2Error;
    return derive((unit *) c, x) ? fmi2Discard : fmi2OK;
}

EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real x[], size_t n)
{
    (void) c, (void) x;
    return n ? fmi2Error : fmi2OK;
}

EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n)
{
    if (n != STATES) return fmi2Error;
    memcpy(x, ((unit *) c)->state, STATES * sizeof(double));
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n)
{
    size_t i;
    (void) c;
    for (i = 0; i < n; i++) x[i] = 1.0;
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer order[], const fmi2Real x[])
{
    (void) c, (void) r, (void) order, (void) x;
    return n ? fmi2Error : fmi2OK;
}

EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer order[], fmi2Real x[])
{
    (void) c, (void) r, (void) order, (void) x;
    return n ? fmi2Error : fmi2OK;
}

EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real at, fmi2Real dt, fmi2Boolean no_set)
{
    unit *u = (unit *) c;
    double coefficient[sizeof VALUES / sizeof VALUES[0]], external[6];
    const double count = ceil(dt / (u->start[12] > 0.0 ? u->start[12] : dt) - 1e-9);
    const long steps = count > 1.0 ? (long) count : 1;
    long k;
    (void) no_set;
    coefficients(u, coefficient);
    for (k = 0; k < steps; k++) {
        if (SPINS) @NAME@_spin(u->input + 9, 0.5 * dt / (double) steps, u->state + 16);
        pushed(u, external);
        if (step_of(coefficient, u->state, u->state + 13, u->input, external, dt / (double) steps)) return fmi2Discard;
        if (SPINS) @NAME@_spin(u->input + 9, 0.5 * dt / (double) steps, u->state + 16);
    }
    u->time = at + dt;
    return fmi2OK;
}

EXPORT fmi2Status fmi2CancelStep(fmi2Component c) { return c ? fmi2Error : fmi2Fatal; }
EXPORT fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind k, fmi2Status *s)
{
    (void) c, (void) k, (void) s;
    return fmi2Discard;
}

EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind k, fmi2Real *s)
{
    if (k != fmi2LastSuccessfulTime) return fmi2Discard;
    *s = ((unit *) c)->time;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind k, fmi2Integer *s)
{
    (void) c, (void) k, (void) s;
    return fmi2Discard;
}

EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind k, fmi2Boolean *s)
{
    (void) c;
    if (k != fmi2Terminated) return fmi2Discard;
    *s = 0;
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind k, fmi2String *s)
{
    (void) c, (void) k, (void) s;
    return fmi2Discard;
}
