% BlueROV2 Heavy, SI: von Benzon et al., J. Marine Science and Engineering 10(12):1898, 2022.
% The values are theirs; the density, fresh water, is added for the tests.
rho = 1000;
m     = 13.5; Ix    = 0.26; Iy    = 0.23; Iz    = 0.37;
Xudot = -6.36; Yvdot = -7.12; Zwdot = -18.68; Kpdot = -0.189;
Mqdot = -0.135; Nrdot = -0.222; Xu    = -13.7; Yv    = 0.0;
Zw    = -33.0; Kp    = 0.0; Mq    = -0.8; Nr    = 0.0;
Xuu   = -141.0; Yvv   = -217.0; Zww   = -190.0; Kpp   = -1.19;
Mqq   = -0.47; Nrr   = -1.5;
