/* The force law of @NAME@.h. Numbers of the vehicle above, one law for all below: docs/force_law.md of coeflab. */

static double at_most(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

static double to_the(double x, int n)
{
    double y = 1.0;
    for (; n > 0; n--) y *= x;
    return y;
}

static double product(int first, int last, const double *x)
{
    double y = 1.0;
    int f;
    for (f = first; f < last; f++) {
        double value = x[FACTORS[3 * f]];
        y *= to_the(FACTORS[3 * f + 2] ? fabs(value) : value, FACTORS[3 * f + 1]);
    }
    return y;
}

static double by_speed(double speed, int n)
{
    return n >= 0 ? to_the(speed, n) : 1.0 / to_the(speed > 1e-9 ? speed : 1e-9, -n);
}

/* Where table k is read: the nearest point of its hull. Gives the share of the free continuation; *inside says whether it is in the hull. */
static double held(int k, const double *x, double *near, int *inside)
{
    const int d = DIMENSION[k], m = SPACE_END[k] - SPACE_BEGIN[k];
    const double *space = SPACES + W * SPACE_BEGIN[k], *face = FACES + W * SPACE_BEGIN[k];
    const double *map = MAPS + W * D * MAP_BEGIN[k];
    double scaled[D] = {0.0}, best = -1.0, t = 0.0;
    int i, j, r, apart = 0;
    *inside = 1;
    for (r = 0; r < m; r++) {
        double away = space[W * r + D];
        double slack = 1e-9 * (fabs(away) > 1.0 ? fabs(away) : 1.0);
        for (i = 0; i < d; i++) away += space[W * r + i] * x[i];
        if (!(away <= slack)) *inside = 0;
    }
    for (i = 0; i < d; i++) near[i] = BOXED[k] ? at_most(x[i], LOW[D * k + i], HIGH[D * k + i]) : x[i];
    if (BOXED[k] || *inside) return 0.0;
    for (i = 0; i < d; i++) scaled[i] = (x[i] - LOW[D * k + i]) / SIZE[D * k + i];
    for (r = MAP_BEGIN[k]; r < MAP_END[k]; r++, map += W * D) {
        double foot[D] = {0.0}, away = 0.0;
        int in = 1;
        for (i = 0; i < d; i++) {
            foot[i] = map[W * i + D];
            for (j = 0; j < d; j++) foot[i] += map[W * i + j] * scaled[j];
            away += (foot[i] - scaled[i]) * (foot[i] - scaled[i]);
        }
        for (j = 0; j < m && in; j++) {
            double beyond = -face[W * j + D];
            for (i = 0; i < d; i++) beyond += face[W * j + i] * foot[i];
            in = beyond <= 1e-9;
        }
        if (in && (best < 0.0 || away < best)) {
            best = away;
            for (i = 0; i < d; i++) near[i] = LOW[D * k + i] + SIZE[D * k + i] * foot[i];
        }
    }
    if (best < 0.0) { /* no nearest point: numbers too large, or none */
        for (i = 0; i < d; i++) near[i] = NAN;
        return 0.0;
    }
    if (RULE[k] != 1) return 0.0;
    for (i = 0; i < d; i++) apart |= LOW[D * k + i] == HIGH[D * k + i] && near[i] != x[i];
    t = sqrt(best) / 0.1;
    if (apart || !(t < 1.0)) return 0.0;
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

static int force_of(const double *c, const double nu[6], const double delta[3], double force[6])
{
    double x[12], total[6 + 3 * WINDS], near[D], point[D];
    double ca, sa, cb, sb, speed, slow;
    int i, k, n, refused = 0;
    for (i = 0; i < 6; i++) x[i] = nu[i];
    for (i = 0; i < 3; i++) x[6 + i] = at_most(delta[i], -LIMIT[i], LIMIT[i]);
    speed = sqrt(nu[0] * nu[0] + nu[1] * nu[1] + nu[2] * nu[2]);
    slow = speed > 1e-9 ? speed : 1e-9;
    x[9] = speed;
    x[10] = ANGLED ? atan2(nu[2] + 0.0, nu[0] + 0.0) : 0.0;
    x[11] = ANGLED && speed > 0.0 ? asin(at_most(nu[1] / speed, -1.0, 1.0)) : 0.0;
    for (i = 0; i < 6 + 3 * WINDS; i++) total[i] = 0.0;
    for (n = 0; n < COEFFICIENTS; n++) {
        double y = c[n] * by_speed(speed, SPEED[n]);
        if (COURSE[n]) y *= at_most(10.0 * nu[0] / slow, -1.0, 1.0);
        total[PLACE[n]] += y * product(FACTOR_BEGIN[n], FACTOR_BEGIN[n + 1], x);
    }
    for (k = 0; k < TABLES; k++) {
        int inside;
        double share;
        for (i = 0; i < DIMENSION[k]; i++) {
            point[i] = x[VARIABLE[D * k + i]];
            if (PRIME[D * k + i] != 0.0) point[i] = point[i] * PRIME[D * k + i] / slow;
        }
        share = held(k, point, near, &inside);
        if (RULE[k] == 2 && !inside && !(RESTS[k] && speed <= 1e-9)) refused = 1;
        for (n = TERM_BEGIN[k]; n < TERM_BEGIN[k + 1]; n++) {
            double y = product(FACTOR_BEGIN[n], FACTOR_BEGIN[n + 1], near);
            if (share > 0.0) y += share * (product(FACTOR_BEGIN[n], FACTOR_BEGIN[n + 1], point) - y);
            total[PLACE[n]] += c[n] * by_speed(speed, SPEED[n]) * y;
        }
    }
    for (n = 0; n < PRODUCTS; n++)
        total[PRODUCT[3 * n]] += IDEAL[n] * nu[PRODUCT[3 * n + 1]] * nu[PRODUCT[3 * n + 2]];
    ca = cos(x[10]), sa = sin(x[10]), cb = cos(x[11]), sb = sin(x[11]);
    for (n = 0; n < WINDS; n++) {
        const int *speaks = SPEAKS + 3 * n;
        const double *wind = total + 6 + 3 * n;
        if (speaks[0]) total[0] += -ca * cb * wind[0] - ca * sb * wind[1] + sa * wind[2];
        if (speaks[1]) total[1] += -sb * wind[0] + cb * wind[1];
        if (speaks[2]) total[2] += -sa * cb * wind[0] - sa * sb * wind[1] - ca * wind[2];
    }
    for (i = 0; i < 6; i++) force[i] = refused ? NAN : total[i];
    return refused;
}

/* A polynomial by segments: the ends hold beyond them, between segments there is nothing. */
static double curve(int first, int last, double x)
{
    int s, k;
    if (first == last) return 0.0;
    x = at_most(x, SEGMENTS[S * first], SEGMENTS[S * (last - 1) + 1]);
    for (s = first; s < last; s++)
        if (SEGMENTS[S * s] <= x && x <= SEGMENTS[S * s + 1]) {
            double y = 0.0;
            for (k = S - 1; k > 1; k--) y = y * x + SEGMENTS[S * s + k];
            return y;
        }
    return 0.0;
}

/* What a thruster does a time after its command: it goes there by its lag. */
static double spun(int n, double before, double command, double time)
{
    return LAG[n] > 0.0 ? command + (before - command) * exp(-time / LAG[n]) : command;
}

void @NAME@_spin(const double command[], double dt, double actual[])
{
    int n;
    for (n = 0; n < THRUSTERS; n++) actual[n] = spun(n, actual[n], command[n], dt);
}

static void add_cross(const double *a, const double *b, double factor, double *out)
{
    out[0] += factor * (a[1] * b[2] - a[2] * b[1]);
    out[1] += factor * (a[2] * b[0] - a[0] * b[2]);
    out[2] += factor * (a[0] * b[1] - a[1] * b[0]);
}

void @NAME@_thrust(const double command[], const double tilt[], double force[6])
{
    int n, i;
    for (i = 0; i < 6; i++) force[i] = 0.0;
    for (n = 0; n < THRUSTERS; n++) {
        const double *t = THRUSTER + 12 * n; /* position, direction, axis, lowest and highest tilt, handedness */
        double way[3], push[3], turned[3] = {0.0, 0.0, 0.0}, thrust, torque;
        const double angle = at_most(tilt ? tilt[n] : 0.0, t[9], t[10]);
        const double on = t[3] * t[6] + t[4] * t[7] + t[5] * t[8];
        if (TILTS[n]) add_cross(t + 6, t + 3, sin(angle), turned);
        for (i = 0; i < 3; i++)
            way[i] = TILTS[n] ? cos(angle) * t[3 + i] + turned[i] + (1.0 - cos(angle)) * on * t[6 + i] : t[3 + i];
        thrust = curve(CURVES[4 * n], CURVES[4 * n + 1], command[n]);
        torque = t[11] * curve(CURVES[4 * n + 2], CURVES[4 * n + 3], command[n]);
        for (i = 0; i < 3; i++) push[i] = thrust * way[i];
        for (i = 0; i < 3; i++) force[i] += push[i], force[3 + i] += torque * way[i];
        add_cross(t, push, 1.0, force + 3);
    }
}

static int accelerate(const double *c, const double nu[6], const double attitude[4], const double delta[3], const double external[6], double rates[6])
{
    double force[6], momentum[6], down[3], moment[3], size = 0.0, q[4];
    int i, j;
    const int refused = force_of(c, nu, delta, force);
    for (i = 0; i < 4; i++) size += attitude[i] * attitude[i];
    for (i = 0; i < 4; i++) q[i] = attitude[i] / sqrt(size);
    down[0] = 2.0 * (q[1] * q[3] - q[0] * q[2]);
    down[1] = 2.0 * (q[2] * q[3] + q[0] * q[1]);
    down[2] = 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]);
    for (i = 0; i < 6; i++) {
        momentum[i] = 0.0;
        for (j = 0; j < 6; j++) momentum[i] += RIGID[6 * i + j] * nu[j];
        force[i] += external[i];
    }
    for (i = 0; i < 3; i++) force[i] += EXCESS * down[i], moment[i] = 0.0;
    add_cross(LEVER, down, 1.0, moment);
    add_cross(nu + 3, momentum, -1.0, force);
    add_cross(nu + 3, momentum + 3, -1.0, moment);
    add_cross(nu, momentum, -1.0, moment);
    for (i = 0; i < 3; i++) force[3 + i] += moment[i];
    for (i = 0; i < 6; i++) {
        rates[i] = 0.0;
        for (j = 0; j < 6; j++) if (INVERSE[6 * i + j] != 0.0) rates[i] += INVERSE[6 * i + j] * force[j];
    }
    return @UPPER@_MOVES ? refused : 2;
}

static int rates_of(const double *c, const double x[13], const double delta[3], const double external[6], double out[13])
{
    const double *q = x + 3, *v = x + 7, *w = x + 10;
    double once[3] = {0.0, 0.0, 0.0}, twice[3] = {0.0, 0.0, 0.0}, spin[3] = {0.0, 0.0, 0.0};
    int i;
    add_cross(q + 1, v, 1.0, once);
    add_cross(q + 1, once, 1.0, twice);
    add_cross(q + 1, w, 1.0, spin);
    for (i = 0; i < 3; i++) out[i] = v[i] + 2.0 * (q[0] * once[i] + twice[i]);
    out[3] = -0.5 * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]);
    for (i = 0; i < 3; i++) out[4 + i] = 0.5 * (q[0] * w[i] + spin[i]);
    return accelerate(c, v, q, delta, external, out + 7);
}

static double turned(int i, double angle, double order, double time)
{
    order = at_most(order, -LIMIT[i], LIMIT[i]);
    return TURNS[i] > 0.0 ? at_most(order, angle - TURNS[i] * time, angle + TURNS[i] * time) : order;
}

static int step_of(const double *c, double x[13], double angles[3], const double order[3], const double external[6], double dt)
{
    static const double PART[4] = {0.0, 0.5, 0.5, 1.0}, WEIGHT[4] = {1.0, 2.0, 2.0, 1.0};
    double at[13], slope[13] = {0.0}, sum[13] = {0.0}, delta[3], size = 0.0;
    int i, k, status = 0;
    for (k = 0; k < 4 && !status; k++) {
        for (i = 0; i < 13; i++) at[i] = x[i] + (k ? PART[k] * dt * slope[i] : 0.0);
        for (i = 0; i < 3; i++) delta[i] = turned(i, angles[i], order[i], PART[k] * dt);
        status = rates_of(c, at, delta, external, slope);
        for (i = 0; i < 13; i++) sum[i] += WEIGHT[k] * slope[i];
    }
    if (status) return status;
    for (i = 0; i < 13; i++) x[i] += dt / 6.0 * sum[i];
    for (i = 3; i < 7; i++) size += x[i] * x[i];
    for (i = 3; i < 7; i++) x[i] /= sqrt(size);
    for (i = 0; i < 3; i++) angles[i] = turned(i, angles[i], order[i], dt);
    return 0;
}

int @NAME@_force(const double nu[6], const double delta[3], double force[6]) { return force_of(VALUES, nu, delta, force); }

int @NAME@_acceleration(const double nu[6], const double attitude[4], const double delta[3], const double external[6], double rates[6])
{
    return accelerate(VALUES, nu, attitude, delta, external, rates);
}

int @NAME@_step(@NAME@_state *s, const double order[3], const double external[6], double dt)
{
    double x[13];
    int i, status;
    for (i = 0; i < 3; i++) x[i] = s->position[i];
    for (i = 0; i < 4; i++) x[3 + i] = s->attitude[i];
    for (i = 0; i < 6; i++) x[7 + i] = s->nu[i];
    status = step_of(VALUES, x, s->angles, order, external, dt);
    if (status) return status;
    for (i = 0; i < 3; i++) s->position[i] = x[i];
    for (i = 0; i < 4; i++) s->attitude[i] = x[3 + i];
    for (i = 0; i < 6; i++) s->nu[i] = x[7 + i];
    return 0;
}
