//! The sources of what is computed, one item each. Doc comments cite them by link, which `rustdoc`
//! checks.

macro_rules! sources {
    ($($(#[doc = $doc:literal])* $key:ident;)+) => {
        $(
            $(#[doc = $doc])*
            #[derive(Debug)]
            pub enum $key {}

            impl $key {
                /// The lines of the documentation of this source, for lists of sources.
                pub const TEXT: &'static str = concat!($($doc, "\n"),*);
            }
        )+
    };
}

sources! {
    /// Y. Bar-Shalom, X. R. Li, T. Kirubarajan, *Estimation with Applications to Tracking and
    /// Navigation*, Wiley, 2001. Kinematic models of targets and their process noise.
    BarShalom2001;
    /// R. M. Brach, R. M. Brach, *Vehicle Accident Analysis and Reconstruction Methods*, 2nd ed.,
    /// SAE International, 2011. Planar impact mechanics, restitution and impulse ratio.
    Brach2011;
    /// K. L. Campbell, *Energy basis for collision severity*, SAE Technical Paper 740565, 1974. Crush
    /// that is linear in the speed of a barrier test; the force per width A + B δ.
    Campbell1974;
    /// M. Carpenter, J. Welcher, *Planar impact with the no-slide condition and a friction limit*,
    /// SAE Technical Paper 2019-01-0422, 2019. Restitution from the point of common velocity,
    /// friction limit, worked barrier example.
    CarpenterWelcher2019;
    /// J.-M. Cornuet, J.-M. Marin, A. Mira, C. P. Robert, *Adaptive multiple importance sampling*,
    /// Scandinavian Journal of Statistics 39(4), 2012. All draws weighted as those of one mixture of
    /// all distributions that were drawn from.
    Cornuet2012;
    /// Transport Canada, *Canadian Vehicle Specifications*: outer dimensions, wheelbases and tracks of
    /// vehicles sold in Canada, as served by the vPIC interface of the NHTSA and collected, rounded to
    /// 1 cm, in the public repository `shifter907/allcarsdb` (`data/body_configs.csv`).
    Cvs2024;
    /// G. A. Davis, *Sample-based estimation of vehicle speeds from yaw marks: Bayesian implementation
    /// using Markov chain Monte Carlo simulation*, SAE Technical Paper 2014-01-0467, 2014. Field studies
    /// of the critical speed: biases within 10 % to 15 % on the average, towards speeds that are too low.
    Davis2014;
    /// Engineering Dynamics Corporation, *EDSMAC: Simulation of Automobile Collisions* and *EDSMAC4*,
    /// program manuals of the HVE environment. Force of two outlines from their crush, share of the crush
    /// that is given back, printed example, stiffness of printed cars.
    EdsmacManual;
    /// U.S. Environmental Protection Agency, *Optimization Model for reducing Emissions of Greenhouse
    /// Gases from Automobiles (OMEGA)*, base year 2022: kerb weights of vehicles by engine and drive, as
    /// in the public repository `USEPA/EPA_OMEGA_Model`
    /// (`omega_model/test_inputs/vehicles_ldv_zevregions.csv`).
    EpaOmega2022;
    /// Esri, *World files for raster datasets*, ArcGIS documentation, 2024. The six numbers of a world
    /// file; the last two are the middle of the left top pixel.
    EsriWorldFiles;
    /// J. R. Funk, J. M. Cormier, C. E. Bain, *Analytical model for investigating low-speed sideswipe
    /// collisions*, SAE Technical Paper 2004-01-1185, 2004. Staged sideswipes that last about a second.
    FunkCormierBain2004;
    /// A. E. Gelfand, D. K. Dey, H. Chang, *Model determination using predictive distributions with
    /// implementation via sampling-based methods*, in Bayesian Statistics 4, Oxford University Press,
    /// 1992. Each observation against what the others predict, by importance weights.
    GelfandDeyChang1992;
    /// A. Gelman, X.-L. Meng, H. Stern, *Posterior predictive assessment of model fitness via realized
    /// discrepancies*, Statistica Sinica 6, 1996.
    GelmanMengStern1996;
    /// P. Del Moral, A. Doucet, A. Jasra, *Sequential Monte Carlo samplers*, Journal of the Royal
    /// Statistical Society B 68(3), 2006. Particles along a sequence of distributions.
    DelMoral2006;
    /// T. D. Gillespie, *Fundamentals of Vehicle Dynamics*, SAE International, 1992. Braking
    /// performance and the distribution of braking forces: chapter 3.
    Gillespie1992;
    /// T. Gneiting, A. E. Raftery, *Strictly proper scoring rules, prediction, and estimation*,
    /// Journal of the American Statistical Association 102(477), 2007. Continuous ranked
    /// probability score, energy score.
    GneitingRaftery2007;
    /// G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed., Johns Hopkins University Press,
    /// 2013. Woodbury's identity.
    GolubVanLoan2013;
    /// S. Gottschalk, M. C. Lin, D. Manocha, *OBBTree: a hierarchical structure for rapid
    /// interference detection*, SIGGRAPH 1996. Separating axes of oriented boxes.
    Gottschalk1996;
    /// E. P. Grimit, T. Gneiting, V. J. Berrocal, N. A. Johnson, *The continuous ranked probability
    /// score for circular variables and its application to mesoscale forecast ensemble
    /// verification*, Quarterly Journal of the Royal Meteorological Society 132, 2006. The score of a
    /// mixture of normals in closed form.
    Grimit2006;
    /// G. J. Heydinger, R. A. Bixel, W. R. Garrott, M. Pyne, J. G. Howe, D. A. Guenther, *Measured
    /// vehicle inertial parameters: NHTSA's data through November 1998*, SAE Technical Paper
    /// 1999-01-1336, 1999. Measured masses, CG heights and moments of inertia of light vehicles. Its
    /// numbers are used as [`KktseInertia2020`] evaluates them.
    Heydinger1999;
    /// ISO 8855:2011, *Road vehicles: Vehicle dynamics and road-holding ability: Vocabulary*. Axes
    /// and signs.
    Iso8855;
    /// A. Jasra, D. A. Stephens, A. Doucet, T. Tsagaris, *Inference for Lévy-driven stochastic
    /// volatility models via adaptive sequential Monte Carlo*, Scandinavian Journal of Statistics
    /// 38(1), 2011. The next temperature from the effective sample size.
    Jasra2011;
    /// kktse.github.io, *Cornering compliances of a typical road vehicle*, 2019. Cornering compliance
    /// of both axles of one car, identified on the road.
    KktseCornering2019;
    /// kktse.github.io, *Estimating vehicle inertia and centre-of-gravity height using the NHTSA light
    /// vehicle inertial parameter database*, 2020. Medians, quartiles and extremes of dynamic indices
    /// and stability factors over the unballasted vehicles of [`Heydinger1999`].
    KktseInertia2020;
    /// National Highway Traffic Safety Administration, *New Car Assessment Program: rollover
    /// resistance measurements*, model year 2004. Tracks, wheelbases, weights and CG of vehicles on
    /// scales and tilt table, with the weight of a driver; as collected in the public repository
    /// `kktse/stunning-octo-doodle-ncap`.
    Ncap2004;
    /// M. C. Kennedy, A. O'Hagan, *Bayesian calibration of computer models*, Journal of the Royal
    /// Statistical Society B 63(3), 2001. Discrepancy between model and reality as a Gaussian process.
    KennedyOHagan2001;
    /// H. Kudlich, *Beitrag zur Mechanik des Kraftfahrzeug-Verkehrsunfalls*, dissertation, Technische
    /// Hochschule Wien, 1966. Impact with compression to a common velocity and restitution as a
    /// share of the impulse of compression; sliding on a contact plane.
    Kudlich1966;
    /// G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, *A physiologically-based model for simulation of
    /// color vision deficiency*, IEEE Transactions on Visualization and Computer Graphics 15(6), 2009.
    /// Matrices for linear red, green and blue.
    Machado2009;
    /// M. D. McKay, R. J. Beckman, W. J. Conover, *A comparison of three methods for selecting values of
    /// input variables in the analysis of output from a computer code*, Technometrics 21(2), 1979.
    /// Latin hypercube sampling.
    McKay1979;
    /// NHTSA, *Consumer Information; New Car Assessment Program; Rollover Resistance*, final policy
    /// statement, 49 CFR Part 575, docket NHTSA-2001-9663 notice 3, Federal Register 68 (2003)
    /// 59249–59304. Fishhook with roll rate feedback.
    Nhtsa2003;
    /// *Standard No. 126; Electronic stability control systems for light vehicles*, Code of Federal
    /// Regulations, title 49, section 571.126. Sine with dwell: sections S5.2, S7.6, S7.9.
    Fmvss126;
    /// NHTSA, *Laboratory Test Procedure for Dynamic Rollover: The Fishhook Maneuver Test Procedure*,
    /// New Car Assessment Program, March 2013. Slowly increasing steer, fishhook: sections 3.1, 3.2.
    Nhtsa2013;
    /// A. Thompson, B. N. Taylor, *Guide for the Use of the International System of Units (SI)*,
    /// NIST Special Publication 811, 2008. Conversion factors.
    Nist2008;
    /// M. Okabe, K. Ito, *Color universal design: how to make figures and presentations that are
    /// friendly to colorblind people*, 2008.
    OkabeIto2008;
    /// comma.ai, *opendbc*: kerb weights of car models, `opendbc/car/*/values.py`, MIT licence.
    Opendbc2025;
    /// A. Owen, Y. Zhou, *Safe and effective importance sampling*, Journal of the American Statistical
    /// Association 95(449), 2000. Mixtures with a defensive component, which bounds the weights.
    OwenZhou2000;
    /// P. Niehoff, H. C. Gabler, *The accuracy of WinSmash delta-V estimates: the influence of vehicle
    /// type, stiffness, and impact mode*, Annual Proceedings of the Association for the Advancement of
    /// Automotive Medicine 50, 2006. Δv from crush against 121 event data recorders: 23 % too low on the
    /// average without restitution, 1 % with it in frontal crashes.
    NiehoffGabler2006;
    /// Y. Jiang, J. Wang, D. Li, *Physics-Informed Neural Network Modeling of Vehicle Collision
    /// Dynamics in Precision Immobilization Technique Maneuvers*, Zhejiang University.
    ///
    /// “The paper” in doc comments: its two physics-informed networks, from the scenario of a collision to the
    /// impact force and from the force to the motion after the impact, are what this program
    /// follows.
    ///
    /// Doc comments name its equations by the labels of its LaTeX source:
    ///
    /// | label | equation |
    /// | --- | --- |
    /// | `eq:state_vector` | state of the 4DOF vehicle: v_x, v_y, yaw, yaw rate, roll, roll rate, X, Y |
    /// | `eq:4dof`, `eq:4dof2` | equations of motion of the 4DOF vehicle; sums of the tire forces and moments |
    /// | `eq:tire_model` to `eq:tire_model4` | lateral force of a tire; slip angles; rolling resistance; vertical loads |
    /// | `eq:collision_model1`, `eq:collision_model2` | conservation of momentum and of angular momentum in a planar impact |
    /// | `eq:restitution_coefficient` to `eq:friction_coefficient2` | restitution; ratio of tangential to normal impulse |
    /// | `eq:pinn-gmmframework` | the force network: scenario and time to the impact force |
    /// | `eq:physic_cons1` to `eq:physic_cons3` | conservation of the impulse as a loss; loss of the dissipated energy |
    /// | `eq:gmmfunction` | mixture of normal distributions of the force at an instant |
    /// | `eq:Adaptive_pinn` to `eq:VSD_PINN_swish` | the response network: force, vehicle and time to the next state; its vehicle encoder |
    /// | `eq:adaptive_weights` | weight of the physics over the epochs and by the distance to the data |
    /// | `eq:consistency_loss`, `eq:all_loss` | loss that keeps the components apart; the whole loss of the response network |
    /// | `eq:baseline:4dof` | the 4DOF model by explicit Euler steps of 10 ms, a baseline |
    PitPinnPaper;
    /// C. E. Rasmussen, C. K. I. Williams, *Gaussian Processes for Machine Learning*, MIT Press,
    /// 2006. Regression, marginal likelihood and its gradient.
    RasmussenWilliams2006;
    /// H. E. Rauch, F. Tung, C. T. Striebel, *Maximum likelihood estimates of linear dynamic systems*,
    /// AIAA Journal 3(8), 1965. Smoothing over a fixed interval.
    RauchTungStriebel1965;
    /// S. Richardson, T. Orton, N. Josevski, W. Pok et al., *A critique of critical speed yaw mark
    /// research*, SAE Technical Paper 2012-01-0600, 2012. Limits of the critical speed and what comes of
    /// its misuse.
    Richardson2012;
    /// P. J. Rousseeuw, *Silhouettes: a graphical aid to the interpretation and validation of cluster
    /// analysis*, Journal of Computational and Applied Mathematics 20, 1987.
    Rousseeuw1987;
    /// SAE J211-1:2014, *Instrumentation for Impact Test, Part 1: Electronic Instrumentation*,
    /// appendix C. Channel frequency classes and their digital filter.
    SaeJ211;
    /// SAE J224:2017, *Collision Deformation Classification*. Clock directions of the principal
    /// direction of force.
    SaeJ224;
    /// SAE J670:2008, *Vehicle Dynamics Terminology*.
    SaeJ670;
    /// A. Slibar, *Die mechanischen Grundsätze des Stoßvorganges freier und geführter Körper und ihre
    /// Anwendung auf den Stoßvorgang von Fahrzeugen*, Archiv für Unfallforschung 2(1), 1966.
    /// Together with [`Kudlich1966`] the impact model of common reconstruction programs.
    Slibar1966;
    /// I. E. Sutherland, G. W. Hodgman, *Reentrant polygon clipping*, Communications of the ACM
    /// 17(1), 1974.
    SutherlandHodgman1974;
    /// S. Talts, M. Betancourt, D. Simpson, A. Vehtari, A. Gelman, *Validating Bayesian inference
    /// algorithms with simulation-based calibration*, arXiv:1804.06788, 2018. Ranks of the truth
    /// among the draws of the posterior.
    Talts2018;
    /// Wikipedia, *Ford Crown Victoria*: kerb weight of the second generation, model years 1998 to
    /// 2011; as copied at `piglix.com/piglix/Crown_Victoria`.
    WikipediaCrownVictoria;
}
