function [tau, MA, h] = file(nu, delta)
% [tau, MA, h] = file(nu, delta) returns the force of the water on a body
% in steady motion, and its added mass. Plain MATLAB language; runs in GNU Octave.
%
%   file, body: body of tow
%
%   nu    = [ u v w p q r ]'  velocity through the water at the reference point (m/s, rad/s)
%   delta = [ dr ds db ]'     rudder, stern plane, bow plane (rad), zero if not given
%                             dr > 0: turns to port (Ndr < 0)
%                             ds > 0: bow down (Mds < 0)
%   tau   = [ X Y Z K M N ]'  force and moment about the reference point (N, N m)
%   MA    = added mass matrix about the reference point, positive (kg, kg m, kg m^2)
%   h     = struct of the coefficients
%
% Axes: x forward, y starboard, z down. Equations of motion with rigid-body MRB and CRB:
%   (MRB + MA)*nu_dot + CRB*nu + g = tau + tau_control
% tau contains -C_A(nu)*nu already (the Munk moment in Nv and Mw): do not add m2c(MA, nu).
% the file has no thruster, so the export has no propulsion: 6.75 N along x keep 1.5 m/s straight ahead.
% for a simulation in six degrees of freedom the file lacks mass (h.m), mass.inertia_matrix (h.I11 ... h.I33) and hydrostatics (h.volume h.g h.xB h.yB h.zB).
%
% Primes: Y = 1/2 rho U^2 L^2 Y', v' = v/U, r' = r L/U, U = |(u, v, w)|; a in a name is an absolute value,
% h.Yvav that of v|v|.

if nargin < 1, nu = zeros(6,1); end
if nargin < 2, delta = zeros(3,1); end

h.coeflab = 1.0;  % layout of this file
h.name = 'file';
h.body = 'body of tow';
h.rho = 1000.0;  % density (kg/m^3)
h.U0 = 1.5;  % speed of the tests (m/s)
h.L = 2.0;  % length of the primes (m)
h.L_name = 'LOA';
h.datum = 'nose';  % where points are measured from
h.x_ref = 0.0;  % reference point (m)
h.y_ref = 0.0;  % reference point (m)
h.z_ref = 0.0;  % reference point (m)
h.MA_body = 'body of tow';
h.MA_method = 'ellipsoid';

% Primed by rho and L: totals, potential part included
h.X0 = -0.0015;  % fit
h.Y0 = 0.0001;  % fit
h.Xvv = 0.004;  % fit
h.Xvr = 0.011;  % fit
h.Yv = -0.03;  % fit
h.Yr = 0.0052;  % fit
h.Yvav = -0.11;  % fit
h.Yavr = -0.002;  % fit
h.Yvvv = -0.21;  % fit
h.Yvrr = -0.07;  % fit
h.Zw = -0.02;  % fit
h.Zq = -0.006;  % fit
h.Zvv = 0.001;  % fit
h.Kp = -0.0001;  % fit
h.Kvw = 0.002;  % fit
h.Mw = 0.012;  % fit
h.Mq = -0.003;  % fit
h.Nv = -0.014;  % fit
h.Nr = -0.004;  % fit
h.Nvav = -0.01;  % fit
h.Nuv = 0.001;  % fit
h.Ydr = 0.01;  % fit
h.Ndr = -0.006;  % fit
h.Xdrdr = -0.002;  % fit
h.Nvdr = 0.0003;  % fit
h.Mds = -0.005;  % fit

% Primed products of the ideal fluid, -C_A(nu)*nu, that no coefficient above covers
h.ideal.Xwq = -0.145;
h.ideal.Ywp = 0.145;
h.ideal.Zvp = -0.15;
h.ideal.Kqr = -0.000125;
h.ideal.Mpr = 0.0044375;
h.ideal.Npq = -0.0043125;

% Primed acceleration derivatives, the negative of the added mass: accelerations computed, the added mass of body of tow by ellipsoid
h.Xudot = -0.005;
h.Yvdot = -0.15;
h.Zwdot = -0.145;
h.Kpdot = -6.25e-05;
h.Mqdot = -0.004375;
h.Nrdot = -0.0045;

u = nu(1);
v = nu(2);
w = nu(3);
p = nu(4);
q = nu(5);
r = nu(6);
dr = delta(1);
ds = delta(2);
U = max(sqrt(u^2 + v^2 + w^2), 1e-9);
course = 0.5*(abs(10*u/U + 1) - abs(10*u/U - 1));  % 1 ahead, -1 astern: drag astern too
r2 = h.rho*h.L^2/2;
r3 = h.rho*h.L^3/2;
r4 = h.rho*h.L^4/2;
r5 = h.rho*h.L^5/2;
X = r2*h.X0*U^2*course ...
    + r2*h.Xvv*v^2 ...
    + r3*h.Xvr*v*r ...
    + r2*h.Xdrdr*U^2*dr^2 ...
    + r3*h.ideal.Xwq*w*q;
Y = r2*h.Y0*U^2 ...
    + r2*h.Yv*U*v ...
    + r3*h.Yr*U*r ...
    + r2*h.Yvav*v*abs(v) ...
    + r3*h.Yavr*abs(v)*r ...
    + r2*h.Yvvv*v^3/U ...
    + r4*h.Yvrr*v*r^2/U ...
    + r2*h.Ydr*U^2*dr ...
    + r3*h.ideal.Ywp*w*p;
Z = r2*h.Zw*U*w ...
    + r3*h.Zq*U*q ...
    + r2*h.Zvv*v^2 ...
    + r3*h.ideal.Zvp*v*p;
K = r4*h.Kp*U*p ...
    + r3*h.Kvw*v*w ...
    + r5*h.ideal.Kqr*q*r;
M = r3*h.Mw*U*w ...
    + r4*h.Mq*U*q ...
    + r3*h.Mds*U^2*ds ...
    + r5*h.ideal.Mpr*p*r;
N = r3*h.Nv*U*v ...
    + r4*h.Nr*U*r ...
    + r3*h.Nvav*v*abs(v) ...
    + r3*h.Nuv*u*v ...
    + r3*h.Ndr*U^2*dr ...
    + r3*h.Nvdr*U*v*dr ...
    + r5*h.ideal.Npq*p*q;
tau = [X; Y; Z; K; M; N];

MA = -[r3*h.Xudot 0 0 0 0 0;
       0 r3*h.Yvdot 0 0 0 0;
       0 0 r3*h.Zwdot 0 0 0;
       0 0 0 r5*h.Kpdot 0 0;
       0 0 0 0 r5*h.Mqdot 0;
       0 0 0 0 0 r5*h.Nrdot];
end
