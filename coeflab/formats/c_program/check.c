/* Holds @name@.c against the law of the parameter file: exit code 0 where all agree. */
#include "@name@.h"
#include <math.h>
#include <stdio.h>

/* nu, delta, attitude, force, rates, 1 where a table refuses */
static const double VECTOR[@count@][26] = {
@rows@
};
static const double SCALE[4] = {@scales@};

int main(void)
{
    const double none[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    double worst = 0.0;
    int k, i, wrong = 0;
    for (k = 0; k < @count@; k++) {
        double force[6], rates[6];
        const double *x = VECTOR[k];
        const int refused = @name@_force(x, x + 6, force);
        const int status = @name@_acceleration(x, x + 9, x + 6, none, rates);
        if (refused != (int) x[25]) wrong++;
        for (i = 0; i < 6 && !refused; i++) {
            const double away = fabs(force[i] - x[13 + i]) / SCALE[i / 3];
            const double rate = status ? 0.0 : fabs(rates[i] - x[19 + i]) / SCALE[2 + i / 3];
            worst = away > worst ? away : worst;
            worst = rate > worst ? rate : worst;
            if (!(away <= 1e-12) || !(rate <= 1e-12)) wrong++;
        }
    }
    printf("@name@: @count@ states, furthest %.1e of the largest, %d wrong\n", worst, wrong);
    return wrong != 0;
}
