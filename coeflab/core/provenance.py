"""Where a number comes from: files by their sha256, sources by their citation.

Works that formulas and data come from; reports print those that were used.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from coeflab.core.declarations import Declaration, Text, Words, one_of
from coeflab.core.stored import Means, Within, stored
from coeflab.core.text.bounded import stream_of

TABLE_KINDS = ("experiment", "cfd", "literature", "synthetic", "estimate", "unstated")
BODY_KINDS = (*TABLE_KINDS, "computed")


@dataclass(frozen=True, slots=True)
class Source(Declaration):
    """Origin of a table or value.

    Attributes
    ----------
    citation : str
        Key of a work of `coeflab.core.provenance`, such as roddy1990, or free text.
    place : str
        Pages or table in the source.
    how_obtained : str
        Printed, computed, read from a figure, synthetic ...
    kind : str
        What the source is; a body may leave it out.
    stated_uncertainty : str
        What the source itself says of its uncertainty; empty if nothing.
    """

    citation: Text
    place: Words = ""
    how_obtained: Words = ""
    kind: Annotated[str, one_of(*BODY_KINDS)] = ""
    stated_uncertainty: Words = ""


@stored()
@dataclass(frozen=True, slots=True)
class InputFile:
    """A file that went in.

    Attributes
    ----------
    name : str
        As written in the plan.
    sha256 : str
    """

    name: Annotated[str, Means("file name")]
    sha256: Annotated[str, Within((("pattern", "^[0-9a-f]{64}$"),)), Means("of its bytes, hexadecimal")]


def sha256_of(path: Path, read: Iterable[Path] = ()) -> str:
    """Hexadecimal sha256 of a file's bytes; of a folder, of the paths in it and the sha256 of what was read there.

    Parameters
    ----------
    path : Path
    read : iterable of Path, optional
        Files of the folder.
    """
    digest = hashlib.sha256()
    if path.is_dir():
        for file in sorted(read):
            place = file.relative_to(path) if file.is_relative_to(path) else file
            digest.update(f"{place.as_posix()} {sha256_of(file)}\n".encode())
        return digest.hexdigest()
    with stream_of(path) as stream:
        for block in iter(lambda: stream.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()


UNNAMED = "of which the copy read here names no authors, journal or year"

WORKS: dict[str, str] = {
    "sname1950": "SNAME, Nomenclature for Treating the Motion of a Submerged Body Through a Fluid, "
    "Technical and Research Bulletin 1-5, 1950.",
    "gertler1967": "M. Gertler, G. R. Hagen, Standard Equations of Motion for Submarine Simulation, NSRDC 2510, 1967.",
    "feldman1979": "J. Feldman, DTNSRDC Revised Standard Submarine Equations of Motion, DTNSRDC/SPD-0393-09, 1979.",
    "imo_msc137": "IMO, Standards for Ship Manoeuvrability, resolution MSC.137(76), 2002, and its explanatory notes, "
    "MSC/Circ.1053.",
    "ittc_free_running": "ITTC, Free Running Model Tests, recommended procedure 7.5-02-06-01, revision 03, 2008.",
    "ittc_roll_decay": "ITTC, Numerical Estimation of Roll Damping, recommended procedure 7.5-02-07-04.5, revision 00, 2011.",
    "roddy1990": "R. F. Roddy, Investigation of the Stability and Control Characteristics of Several Configurations of "
    "the DARPA SUBOFF Model (DTRC Model 5470) from Captive-Model Experiments, DTRC/SHD-1298-08, 1990.",
    "groves1989": "N. C. Groves, T. T. Huang, M. S. Chang, Geometric Characteristics of DARPA SUBOFF Models, "
    "DTRC/SHD-1298-01, 1989.",
    "steady_cfd": "Calculation of Linear Damping Coefficients by Numerical Simulation of Steady State Experiments, "
    f"{UNNAMED}; Table 4 (published CFD, PMM CFD 2012, experiment 1990).",
    "coeflab_cfd": "coeflab, Steady RANS of the SUBOFF bare hull, made for this project with OpenFOAM 1912, 2026.",
    "ittc_captive": "ITTC, Captive Model Test Procedures, recommended procedure 7.5-02-06-02, revision 04, 2014.",
    "gertler1959": "M. Gertler, The DTMB Planar-Motion-Mechanism System, Symposium on Towing Tank Facilities, Zagreb, 1959.",
    "liang_zeger1986": "K.-Y. Liang, S. L. Zeger, Longitudinal data analysis using generalized linear models, Biometrika 73, 1986.",
    "schwarz1978": "G. Schwarz, Estimating the dimension of a model, Annals of Statistics 6(2), 1978.",
    "hairer1996": "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II: Stiff and Differential-Algebraic "
    "Problems, 2nd edition, Springer, 1996, section IV.2.",
    "hindmarsh1983": "A. C. Hindmarsh, ODEPACK, a systematized collection of ODE solvers, in R. S. Stepleman et al. (editors), "
    "Scientific Computing, IMACS, North-Holland, 1983.",
    "fossen2011": "T. I. Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, Wiley, 2011.",
    "mackinnon1985": "J. G. MacKinnon, H. White, Some heteroskedasticity-consistent covariance matrix estimators with "
    "improved finite sample properties, J. Econometrics 29, 1985.",
    "bell2002": "R. M. Bell, D. F. McCaffrey, Bias reduction in standard errors for linear regression with multi-stage "
    "samples, Survey Methodology 28(2), 2002.",
    "imbens2016": "G. W. Imbens, M. Kolesar, Robust standard errors in small samples: some practical advice, "
    "Rev. Economics and Statistics 98(4), 2016.",
    "wahba1990": "G. Wahba, Spline Models for Observational Data, SIAM, 1990.",
    "kimeldorf1970": "G. S. Kimeldorf, G. Wahba, A correspondence between Bayesian estimation on stochastic processes and "
    "smoothing by splines, Ann. Math. Statist. 41, 1970.",
    "grunwald2017": "P. Gruenwald, T. van Ommen, Inconsistency of Bayesian inference for misspecified linear models, and a "
    "proposal for repairing it, Bayesian Analysis 12, 2017.",
    "hurvich1989": "C. M. Hurvich, C.-L. Tsai, Regression and time series model selection in small samples, "
    "Biometrika 76, 1989.",
    "ittc_water": "ITTC, Fresh Water and Seawater Properties, recommended procedure 7.5-02-01-03, revision 02, 2011.",
    "ittc_uncertainty": "ITTC, Uncertainty Analysis in CFD, Verification and Validation, recommended procedure 7.5-03-01-01, 2008, "
    "and Uncertainty Analysis for Manoeuvring Predictions based on Captive Manoeuvring Tests, 7.5-02-06-04, 2014.",
    "tj_flyingfish": "Modeling and operating point analysis for aquatic translational motion of a cross-medium vehicle "
    f"(TJ-FlyingFish), {UNNAMED}; equations 13-18, 25-56 and Table 1.",
    "thauv": "Analysis of a New Twin Hybrid Autonomous Underwater Vehicle (THAUV), Applied Sciences 13(3), 1551, 2023, "
    "doi 10.3390/app13031551 (the copy read here names no authors); equations 5, 9-30 and Table 3.",
    "urv_kane": "T. J. Tarn, G. A. Shoults, S. P. Yang, A Dynamic Model of an Underwater Vehicle with a Robotic Manipulator using "
    "Kane's Method, Autonomous Robots 3, 1996 (authors and journal from memory: the copy read here names none).",
    "yoerger1990": "D. R. Yoerger, J. G. Cooke, J.-J. E. Slotine, The influence of thruster dynamics on underwater vehicle behavior and "
    "their incorporation into control system design, IEEE J. Oceanic Engineering 15(3), 167-177, 1990.",
    "healey1994": "A. J. Healey, S. M. Rock, S. Cody, D. Miles, J. P. Brown, Toward an improved understanding of thruster dynamics for "
    "underwater vehicles, Proceedings of the 1994 Symposium on Autonomous Underwater Vehicle Technology, 340-352 (as the URV paper "
    "cites it; its functions are written here from memory, no copy was read).",
    "leonard_graver2001": "N. E. Leonard, J. G. Graver, Model-based feedback control of autonomous underwater gliders, IEEE J. "
    "Oceanic Engineering 26(4), 2001.",
    "huuv2025": "T. Talarczyk, M. Morawski, M. Malec, M. Garncarz, Identification of Motion Model Parameters for a Small "
    "Hybrid-Propelled Unmanned Underwater Vehicle (HUUV), Technical Transactions, e2025031, 2025, doi 10.37705/TechTrans/e2025031.",
    "allen1974": "D. M. Allen, The relationship between variable selection and data augmentation and a method for "
    "prediction, Technometrics 16, 1974.",
    "huuv_synthetic": "coeflab, Synthetic table of a vehicle like the HUUV, made for this project from stated coefficients by "
    "cfd_data/make_synthetic_huuv.py, 2026; neither measured nor computed by CFD.",
    "pmm_synthetic": "coeflab, Synthetic runs of a planar motion mechanism and steady tables of the same law, made for this project by "
    "cfd_data/make_pmm_synthetic.py, 2026; neither measured nor computed by CFD.",
    "roache1998": "P. J. Roache, Verification and Validation in Computational Science and Engineering, Hermosa, 1998.",
    "celik2008": "I. B. Celik, U. Ghia, P. J. Roache, C. J. Freitas, H. Coleman, P. E. Raad, Procedure for Estimation and "
    "Reporting of Uncertainty Due to Discretization in CFD Applications, J. Fluids Engineering 130, 078001, 2008.",
    "eca2014": "L. Eca, M. Hoekstra, A procedure for the estimation of the numerical uncertainty of CFD calculations based "
    "on grid refinement studies, J. Computational Physics 262, 2014.",
    "oberkampf2010": "W. L. Oberkampf, C. J. Roy, Verification and Validation in Scientific Computing, Cambridge, 2010.",
    "asme_vv20": "ASME V&V 20-2009, Standard for Verification and Validation in Computational Fluid Dynamics and Heat "
    "Transfer, 2009.",
    "jcgm100": "JCGM 100:2008, Evaluation of measurement data: Guide to the expression of uncertainty in measurement, and "
    "JCGM 101:2008, Propagation of distributions using a Monte Carlo method.",
    "chow1960": "G. C. Chow, Tests of equality between sets of coefficients in two linear regressions, Econometrica "
    "28(3), 1960.",
    "tipton2015": "E. Tipton, J. E. Pustejovsky, Small-sample adjustments for tests of moderators and model fit using "
    "robust variance estimation in meta-regression, J. Educational and Behavioral Statistics 40(6), 2015.",
    "brunton2016": "S. L. Brunton, J. L. Proctor, J. N. Kutz, Discovering governing equations from data by sparse "
    "identification of nonlinear dynamical systems, PNAS 113(15), 2016.",
    "kaptanoglu2022": "A. A. Kaptanoglu, B. M. de Silva, U. Fasel, K. Kaheman, A. J. Goldschmidt, J. Callaham, C. B. Delahunt, "
    "Z. G. Nicolaou, K. Champion, J.-C. Loiseau, J. N. Kutz, S. L. Brunton, PySINDy: A comprehensive Python package for robust sparse system "
    "identification, J. Open Source Software 7(69), 2022.",
    "fasel2022": "U. Fasel, J. N. Kutz, B. W. Brunton, S. L. Brunton, Ensemble-SINDy: Robust sparse model discovery in the low-data, "
    "high-noise limit, with active learning and control, Proc. Royal Society A 478, 2022.",
    "messenger2021": "D. A. Messenger, D. M. Bortz, Weak SINDy: Galerkin-based data-driven model selection, Multiscale Modeling "
    "and Simulation 19(3), 2021.",
    "gurevich2019": "D. R. Gurevich, P. A. K. Reinbold, R. O. Grigoriev, Robust and optimal sparse regression for nonlinear PDE "
    "models, Chaos 29, 2019.",
    "soderstrom1983": "T. Soderstrom, P. Stoica, Instrumental Variable Methods for System Identification, Springer, 1983.",
    "chen2008": "J. Chen, Z. Chen, Extended Bayesian information criteria for model selection with large model spaces, "
    "Biometrika 95(3), 2008.",
    "stern2001": "F. Stern, R. V. Wilson, H. W. Coleman, E. G. Paterson, Comprehensive approach to verification and validation of CFD "
    "simulations - Part 1: methodology and procedures, J. Fluids Engineering 123, 2001.",
    "white1997": "K. P. White, An effective truncation heuristic for bias reduction in simulation output, Simulation 69(6), 1997; as "
    "MSER-5 in K. P. White, M. J. Cobb, S. C. Spratt, A comparison of five steady-state truncation heuristics for simulation, Winter "
    "Simulation Conference, 2000.",
    "conway1963": "R. W. Conway, Some tactical problems in digital simulation, Management Science 10(1), 1963.",
    "geyer1992": "C. J. Geyer, Practical Markov chain Monte Carlo, Statistical Science 7(4), 1992.",
    "flegal2010": "J. M. Flegal, G. L. Jones, Batch means and spectral variance estimators in Markov chain Monte Carlo, Annals of "
    "Statistics 38(2), 2010.",
    "wolff2004": "U. Wolff, Monte Carlo errors with less errors, Computer Physics Communications 156, 2004.",
    "kendall1954": "M. G. Kendall, Note on bias in the estimation of autocorrelation, Biometrika 41, 1954.",
    "lamb1918": "H. Lamb, The Inertia-Coefficients of an Ellipsoid Moving in Fluid, Aeronautical Research Committee, Reports and "
    "Memoranda 623, 1918.",
    "whicker1958": "L. F. Whicker, L. F. Fehlner, Free-Stream Characteristics of a Family of Low-Aspect-Ratio, All-Movable Control "
    "Surfaces for Application to Ship Design, David Taylor Model Basin Report 933, 1958.",
    "lamb1932": "H. Lamb, Hydrodynamics, 6th edition, Cambridge, 1932, sections 114, 115 and 121 a.",
    "carlson1995": "B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numerical Algorithms 10, "
    "1995.",
    "newman1977": "J. N. Newman, Marine Hydrodynamics, MIT Press, 1977, sections 4.13-4.16.",
    "myring1976": "D. F. Myring, A theoretical study of body drag in subcritical axisymmetric flow, Aeronautical Quarterly "
    "27(3), 1976.",
    "prestero2001": "T. Prestero, Verification of a Six-Degree of Freedom Simulation Model for the REMUS Autonomous "
    "Underwater Vehicle, MSc thesis, MIT and WHOI, 2001.",
    "hess1967": "J. L. Hess, A. M. O. Smith, Calculation of potential flow about arbitrary bodies, Progress in Aeronautical "
    "Sciences 8, 1967.",
    "vanoosterom1983": "A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomedical "
    "Engineering 30, 1983.",
    "wilton1984": "D. R. Wilton, S. M. Rao, A. W. Glisson, D. H. Schaubert, O. M. Al-Bundak, C. M. Butler, Potential integrals for uniform and linear source distributions on polygonal and "
    "polyhedral domains, IEEE Trans. Antennas and Propagation 32, 1984.",
    "cohensteiner2003": "D. Cohen-Steiner, J.-M. Morvan, Restricted Delaunay triangulations and normal cycle, Symposium on "
    "Computational Geometry, 2003.",
    "eberly2002": "D. Eberly, Polyhedral Mass Properties (Revisited), Geometric Tools, 2002.",
    "bryson1954": "A. E. Bryson, Evaluation of the inertia coefficients of the cross-section of a slender body, "
    "J. Aeronautical Sciences 21, 1954.",
    "coeflab_plates": "coeflab, Added mass of rectangular plates at eleven aspects from 1 to 10, computed for this project with a "
    "lattice of doublets, extrapolated, to 1e-4, 2026.",
    "ittc1957": "ITTC, Proceedings of the 8th International Towing Tank Conference, Madrid, 1957: the model-ship correlation line.",
    "townsin1990": "R. L. Townsin, S. K. Dey, The correlation of roughness drag with surface characteristics, RINA International "
    "Workshop on Marine Roughness and Drag, 1990; in ITTC, recommended procedure 7.5-02-02-02.",
    "hoerner1965": "S. F. Hoerner, Fluid-Dynamic Drag, published by the author, 1965.",
    "schlichting1979": "H. Schlichting, Boundary-Layer Theory, 7th edition, McGraw-Hill, 1979.",
    "jones1946": "R. T. Jones, Properties of Low-Aspect-Ratio Pointed Wings at Speeds Below and Above the Speed of Sound, "
    "NACA Report 835, 1946.",
    "gillmer1982": "T. C. Gillmer, B. Johnson, Introduction to Naval Architecture, Naval Institute Press, 1982.",
    "allen1951": "H. J. Allen, E. W. Perkins, A study of effects of viscosity on flow over slender inclined bodies of revolution, "
    "NACA Report 1048, 1951.",
    "roshko1961": "A. Roshko, Experiments on the flow past a circular cylinder at very high Reynolds number, J. Fluid Mechanics "
    "10, 1961.",
    "munk1924": "M. M. Munk, The aerodynamic forces on airship hulls, NACA Report 184, 1924.",
    "hopkins1951": "E. J. Hopkins, A semiempirical method for calculating the pitching moment of bodies of revolution at low Mach "
    "numbers, NACA RM A51C14, 1951.",
    "pitts1957": "W. C. Pitts, J. N. Nielsen, G. E. Kaattari, Lift and center of pressure of wing-body-tail combinations at "
    "subsonic, transonic, and supersonic speeds, NACA Report 1307, 1957.",
    "lighthill1960": "M. J. Lighthill, Note on the swimming of slender fish, J. Fluid Mechanics 9, 1960.",
    "glauert1926": "H. Glauert, The Elements of Aerofoil and Airscrew Theory, Cambridge, 1926.",
    "weissinger1955": "J. Weissinger, Zur Aerodynamik des Ringfluegels, Deutsche Versuchsanstalt fuer Luftfahrt, DVL-Bericht 2, 1955.",
    "fletcher1957": "H. S. Fletcher, Experimental investigation of lift, drag, and pitching moment of five annular airfoils, "
    "NACA TN 4117, 1957.",
    "ribner1945": "H. S. Ribner, Formulas for propellers in yaw and charts of the side-force derivative, NACA report 819, and "
    "Propellers in yaw, NACA report 820, 1945.",
    "young1965": "J. de Young, Propeller at high incidence, Journal of Aircraft 2(3), 1965, as quoted by S. S. Chauhan, J. R. R. A. Martins, "
    "Tilt-wing eVTOL takeoff trajectory optimization, Journal of Aircraft 57(1), 2020.",
    "bernitsas1981": "M. M. Bernitsas, D. Ray, P. Kinley, KT, KQ and efficiency curves for the Wageningen B-series propellers, "
    "University of Michigan, report 237, 1981.",
    "mss": "T. I. Fossen, T. Perez, Marine Systems Simulator (MSS), 2004, VESSELS/npsauv.m and VESSELS/navalvessel.m, "
    "github.com/cybergalactic/MSS.",
    "python_vehicle_simulator": "T. I. Fossen, Python Vehicle Simulator, as of 2026, src/python_vehicle_simulator/vehicles/remus100.py "
    "and lib/mainLoop.py, github.com/cybergalactic/PythonVehicleSimulator.",
    "gz_sim": "Open Source Robotics Foundation, Gazebo Sim, src/systems/hydrodynamics/Hydrodynamics.cc and HydrodynamicsUtils.hh, commit 42d1720 of 2026, "
    "github.com/gazebosim/gz-sim.",
    "uuv_simulator": "M. M. M. Manhaes, S. A. Scherer, M. Voss, L. R. Douat, T. Rauschenbach, UUV Simulator: A Gazebo-based package for underwater intervention and "
    "multi-robot simulation, OCEANS 2016; HydrodynamicModel.cc, commit bea0a1b, github.com/uuvsimulator/uuv_simulator.",
    "xdyn": "Sirehna, Naval Group, xdyn 26.8, as of 2026, a lightweight time-domain ship simulator, github.com/naval-group/lxdyn; "
    "force laws read in xdyn/core and xdyn/force_models.",
    "mujoco": "E. Todorov, T. Erez, Y. Tassa, MuJoCo: A physics engine for model-based control, IROS 2012; documentation, "
    "chapter Fluid forces, and engine_passive.c, commit 01a932e, github.com/google-deepmind/mujoco.",
    "fmi2": "Modelica Association, Functional Mock-up Interface for Model Exchange and Co-Simulation, version 2.0.4, 2022, "
    "fmi-standard.org.",
    "holoocean": "E. Potokar, S. Ashford, M. Kaess, J. G. Mangelson, HoloOcean: An Underwater Robotics Simulator, ICRA 2022; "
    "version 2.3, client/src/holoocean/fossen_dynamics/torpedo.py and helper_functions.py.",
    "stonefish": "P. Cieslak, Stonefish: An Advanced Open-Source Simulation Tool Designed for Marine Robotics, OCEANS 2019; "
    "Library/src/entities/SolidEntity.cpp, commit 3857913, github.com/patrykcieslak/stonefish.",
}


def work(key: str) -> str:
    """Full reference of a key; a text that is no key is returned as it is."""
    return WORKS.get(key, key)
