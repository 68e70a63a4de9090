% A torpedo-shaped vehicle in slug, foot and pound, as tabulated in the public MATLAB model MIT_model.m.
% The values are theirs; density and gravity are added for the tests.
rho = 1.94;  % slug/ft^3
g = 32.174;  % ft/s^2
m = 1.97;  % slug
Ix    = 0.3; Iy    = 2.3; Iz    = 2.3; Xudot = -0.35;
Yvdot = -1.48; Zwdot = -1.32; Kpdot = -0.025; Mqdot = -0.41;
Nrdot = -0.38; Muw   = 1.57; Nuv   = -1.57; Xuu   = -0.84;
Yvv   = -3.0; Zww   = -3.49;
