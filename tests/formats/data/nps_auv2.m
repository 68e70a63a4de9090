% NPS AUV II, primed derivatives: Healey and Lienard, IEEE J. Oceanic Engineering 18(3), 1993, as tabulated in
% MSS VESSELS/npsauv.m. The values are theirs; this file is written for the tests.
L     = 5.3; rho   = 1025.0; Ix    = 2038.0; Iy    = 13587.0;
Iz    = 13587.0; zG    = 0.061;
r2 = rho*L^2/2; r3 = rho*L^3/2; ... a comment after a continuation
r4 = rho*L^4/2; r5 = rho*L^5/2;
Cdy   = 0.5; Cdz   = 0.6; Xudot = -0.0076; Xpp   = 0.007;
Xqq   = -0.015; Xrr   = 0.004; Xpr   = 0.00075; Xwq   = -0.2;
Xvp   = -0.003; Xvr   = 0.02; Xvv   = 0.053; Xww   = 0.17;
Ypdot = 0.00012; Yrdot = 0.0012; Yvdot = -0.055; Yp    = 0.003;
Yr    = 0.03; Yv    = -0.1; Yvq   = 0.024; Ywp   = 0.23;
Ywr   = -0.019; Yvw   = 0.068; Ypq   = 0.004; Yqr   = -0.0065;
Ydr   = 0.027; Zqdot = -0.0068; Zwdot = -0.24; Zq    = -0.14;
Zw    = -0.3; Zpp   = 0.00013; Zpr   = 0.0067; Zrr   = -0.0074;
Zvp   = -0.048; Zvr   = 0.045; Zvv   = -0.068; Zds   = -0.073;
Kpdot = -0.001; Krdot = -3.4e-05; Kvdot = 0.00012; Kp    = -0.011;
Kr    = -0.00084; Kv    = 0.0031; Kvw   = -0.19; Kpq   = -6.9e-05;
Kqr   = 0.017; Mqdot = -0.017; Mwdot = -0.0068; Muq   = -0.068;
Muw   = 0.1; Mvv   = -0.026; Mpp   = 5.3e-05; Mpr   = 0.005;
Mrr   = 0.0029; Mvp   = 0.0012; Mvr   = 0.017; Mds   = -0.041;
Npdot = -3.4e-05; Nrdot = -0.0034; Nvdot = 0.0012; Np    = -0.00084;
Nr    = -0.016; Nv    = -0.0074; Nvq   = -0.01; Nvw   = -0.027;
Nwp   = -0.017; Nwr   = 0.0074; Npq   = -0.021; Nqr   = 0.0027;
Ndr   = -0.013;
