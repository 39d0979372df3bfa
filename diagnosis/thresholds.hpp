#pragma once

#include <cstddef>
// Design: docs/decisions/0513-thresholds.md
namespace joulepath {

// Every number that decides what a diagnosis says, with its origin:
//   derived         a quantile, a false-alarm rate or a likelihood ratio, as said
//   physical scale  an order of magnitude of small wheeled robots
//   declared        a convention of the answer: what is listed, what counts as material
//   calibrated      by the named command
//   chosen          by hand on development cases (benchmarks/results/blind.md); no command repeats the choice
// A number in parentheses is the decision in docs/decisions that tells why. Tolerances of the arithmetic stay
// where they are used, as do grids of values that are tried, the forms of unknown terms, and the numbers of
// the monitor and of calibrations.

// Runs and samples.

/// Fewer usable runs name nothing. Declared: three to fit, one to judge.
inline constexpr std::size_t kLeastRunsToName = 4;
/// Parts of the runs of which each is judged by a fit of the others. Chosen: as many fits.
inline constexpr std::size_t kFolds = 5;
/// With fewer held-out runs their scatter says little. Chosen: guards datasets with validation runs of their
/// own.
inline constexpr std::size_t kFewHeldOut = 3;
/// With fewer diagnosis runs noise and scatter are known less: effects below the materiality floor need
/// kSmallEffectEvidenceOfFewRuns. Chosen.
inline constexpr std::size_t kRunsForSmallEffects = 8;
/// Travel of one wheel beyond the other's over their sum, from which on a run turns; folds share such runs.
/// Chosen.
inline constexpr double kTurningRun = 0.1;
/// Of a log that can be smoothed, of a channel whose memory and of a pair of channels whose correlation is
/// estimated. Chosen: guards short logs and channels that few rows have.
inline constexpr std::size_t kLeastSamples = 40;
/// Of a log that can be smoothed. Derived: the width of the kernel, 7 kKernelSigma_s, and two periods of a
/// log of kLeastSamples; a shorter log may leave no row.
inline constexpr double kLeastLength_s = 0.5;
/// Of all runs together; longer logs are thinned out more. Declared: bounds memory and time.
inline constexpr double kMostRows = 12000.0;
/// Between rows, at most; logs of more than 80 minutes have more rows. Derived: a delay spans three rows on
/// each side.
inline constexpr double kCoarsestPeriod_s = 0.4;
/// Of the Gaussian that smooths every channel. Chosen.
inline constexpr double kKernelSigma_s = 0.06;
/// Between samples after smoothing. Chosen.
inline constexpr double kPeriod_s = 0.1;
/// Kernel over the log's period, at least. Chosen: guards logs below 20 Hz, where a narrower one has no
/// slope.
inline constexpr double kLeastKernelPeriods = 1.2;
/// A period off by this share makes the log one that is resampled. Chosen: guards logs with lost samples.
inline constexpr double kUnevenPeriod = 0.05;
/// Samples of an even grid over those of an uneven log, at most. Declared: bounds memory.
inline constexpr double kMostGrowth = 50.0;
/// Mean square of an acceleration over that of the encoders' noise, below which it counts as none. Derived:
/// 99.9 % of windows of eleven samples of noise are below, at kPeriod_s and logs of 50 Hz and more (0501).
inline constexpr double kAccelerationOverNoise = 3.0;
/// Square of the mean of such a window over the variance of a mean of noise, below which it counts as none.
/// Derived: 99 % of means of noise are below. One that is not has a hundredth of a sample's noise.
inline constexpr double kMeanOverNoise = 6.6;
/// Half the width of such a window. Chosen (0501).
inline constexpr double kAccelerationWindow_s = 0.5;
/// kAccelerationOverNoise of jerks, over three samples. Chosen (0501): guards stiffnesses of contacts against
/// the smoothing of noise.
inline constexpr double kJerkOverNoise = 5.0;
/// Samples further apart tell noise from motion no more. Chosen (0501).
inline constexpr double kLongestNoisePeriod_s = 0.2;
/// Below it dry friction has no known direction under the kernel. Chosen.
inline constexpr double kLeastTurningSpeed_rad_s = 0.5;
/// Below it the direction of a wheel's rotation is uncertain. Chosen.
inline constexpr double kBlurredWheel_rad_s = 0.2;
/// The same of a sample's speed or current, in standard deviations of its noise: one in 16,000 samples is
/// beyond. Chosen.
inline constexpr double kSampleOverNoise = 4.0;
/// The least of it. Physical scale: an encoder without noise.
inline constexpr double kStillWheel_rad_s = 0.02;
/// The same of the body's speed. Physical scale: a log's noise.
inline constexpr double kStillSpeed_m_s = 0.02;
/// Below it the direction of a turn is uncertain. Physical scale: the noise of a smoothed yaw rate, of
/// encoders with a thousand steps.
inline constexpr double kStillYawRate_rad_s = 0.01;
/// Mean sign of a yaw rate from which on the robot surely turns. Chosen: 2.6 of its standard deviations.
inline constexpr double kSureTurn = 0.99;
/// Below it the direction of a turn is uncertain for an unknown moment. Physical scale.
inline constexpr double kBlurredTurn_rad_s = 0.04;
/// The same of a motor's current. Physical scale.
inline constexpr double kBlurredCurrent_A = 0.03;
/// Motor currents below it may lie in a driver's dead band. Physical scale.
inline constexpr double kDeadBand_A = 0.1;

// Data that contradict physics. Sound data stay far from these numbers; `./dev bench spoilt` exercises them.

/// A channel that shows less of the change that the others ask for is dead. Chosen (0500).
inline constexpr double kDeadShare = 0.1;
/// And whose own change is smaller than this part of it. Chosen (0500).
inline constexpr double kDeadSize = 0.3;
/// The windings' equation is sound where it leaves a smaller share unexplained. Chosen (0500).
inline constexpr double kSoundWinding = 0.004;
/// Above it a side or a sign may be wrong: the drop R i is a small part of the voltage. Chosen (0500).
inline constexpr double kDoubtfulWinding = 0.0001;
/// As kSoundWinding, of currents against the motion's torques. Chosen (0500).
inline constexpr double kSoundTorque = 0.3;
/// The same of turning rates against each other and of positions against the wheels. Chosen (0500).
inline constexpr double kSoundMotion = 0.1;
/// The same of the battery's power against the motors'. Chosen (0500).
inline constexpr double kSoundBattery = 0.05;
/// Above it the scale of the motors' currents may be wrong: standby hides a factor. Chosen (0500).
inline constexpr double kDoubtfulBattery = 0.0001;
/// A relation that leaves a smaller share unexplained is exact: repairs are weighed no finer. Chosen (0500).
inline constexpr double kExactRelation = 1e-5;
/// Exponent of the coefficients' boxes while a factor is refined: they are nearly fixed. Chosen (0500).
inline constexpr double kRefinementFreedom = 0.05;
/// Rows of a relation beyond its coefficients. Derived: what fewer rows leave unexplained is noise to more
/// than a factor of 2 (chi-square of 10, 95 %); with none, every relation is exact.
inline constexpr std::ptrdiff_t kLeastFreeRows = 10;
/// A repair must lower what a relation leaves unexplained by this factor. Chosen (0500).
inline constexpr double kRepairGain = 4.0;
/// The same of a relation that is doubtful only. Chosen (0500).
inline constexpr double kRepairGainOfDoubtful = 10.0;
/// And may raise it for no other one by more than this, unless that stays sound. Chosen (0500).
inline constexpr double kRepairHarm = 1.5;
/// A factor that is no unit must be this many nats better than a fault that is usual. Chosen (0500).
inline constexpr double kUnusualFault = 1.0;
/// A smaller factor or divisor of a channel may be an effect. Declared.
inline constexpr double kMostEffectFactor = 1.5;
/// A unit's factor from which on noise tells it: vibration multiplies a gyro's noise by less. Chosen (0500).
inline constexpr double kLeastNoiseOfUnit = 30.0;
/// Noise (SI units) below which a channel was computed, not measured. Physical scale (0500).
inline constexpr double kLeastSensorNoise = 1e-6;
/// A run with another unit is noisier than every other run by this factor. Declared (0500).
inline constexpr double kNoiseApart = 3.0;
/// Exponent of the coefficients' boxes where one run is held against the others. Chosen (0500).
inline constexpr double kComparedFreedom = 0.2;
/// Kinds of laws that a run has to break where no other run does: an effect breaks one. Chosen (0500).
inline constexpr std::size_t kLeastOddKinds = 2;
/// Faults of one dataset that are sought. Declared: bounds time.
inline constexpr int kMostFaults = 6;

// Boxes of the relations between channels: what calibration errors and effects of the catalog may change.

/// Rows over which changes of a pose are taken: those of single rows disappear in the noise. Chosen (0500).
inline constexpr std::ptrdiff_t kIncrementRows = 6;
/// Runs that turn less do not test a gyro or a heading. Physical scale.
inline constexpr double kLeastYawRate_rad_s = 0.06;
/// Runs that travel less do not test a position. Physical scale.
inline constexpr double kLeastSpeed_m_s = 0.04;
/// Of readings: a speed that changes within this time looks like an offset. Physical scale.
inline constexpr double kLongestDelay_s = 0.15;
/// Of a current sensor, over the current that friction takes. Chosen (0500).
inline constexpr double kGreatestOffset = 0.7;
/// Of a driver's voltage, over the greatest voltage. Physical scale.
inline constexpr double kGreatestDrop = 0.035;
/// A winding's resistance or a converter's power over the file's, from measured channels. Chosen (0500).
inline constexpr double kLeastMeasuredFactor = 0.6;
/// See kLeastMeasuredFactor. Chosen (0500).
inline constexpr double kMostMeasuredFactor = 1.7;
/// The same where the current is predicted: resistances of the floor multiply it. Chosen (0500).
inline constexpr double kLeastPredictedFactor = 0.2;
/// See kLeastPredictedFactor. Chosen (0500).
inline constexpr double kMostPredictedCurrent = 5.0;
/// The same of a predicted power. Chosen (0500).
inline constexpr double kMostPredictedPower = 6.0;
/// A motor constant or an instrument's scale over the file's. Chosen (0500).
inline constexpr double kLeastScale = 0.7;
/// See kLeastScale. Chosen (0500).
inline constexpr double kMostScale = 1.4;
/// Dry friction over the file's. Chosen (0500).
inline constexpr double kLeastFriction = 0.3;
/// See kLeastFriction. Chosen (0500).
inline constexpr double kMostFriction = 5.0;
/// Torque per wheel speed over the file's, of bearings or of drag that looks like it. Chosen (0500).
inline constexpr double kMostTorquePerSpeed = 20.0;
/// Inertia over the file's. Chosen (0500).
inline constexpr double kLeastInertia = 0.4;
/// See kLeastInertia. Chosen (0500).
inline constexpr double kMostInertia = 2.5;
/// Resistance to turning over the weight. Physical scale.
inline constexpr double kGreatestTurningLoad = 0.05;
/// Slope of the floor. Physical scale.
inline constexpr double kGreatestSlope = 0.03;
/// Distance or angle over what the wheels roll: radii, track width, slip. Chosen (0500).
inline constexpr double kLeastRolled = 0.55;
/// See kLeastRolled. Chosen (0500).
inline constexpr double kMostRolled = 1.6;
/// Difference of the wheels' radii over their mean. Physical scale.
inline constexpr double kGreatestMismatch = 0.08;
/// Bias of a gyro. Physical scale: an uncalibrated one.
inline constexpr double kGreatestGyroBias_rad_s = 0.1;
/// Error of a heading's zero. Physical scale.
inline constexpr double kGreatestHeadingOffset_rad = 0.4;
/// Braking power that a battery takes with the sign of a draw, over that of driving. Chosen (0500).
inline constexpr double kGreatestBrakeDraw = 0.3;
/// Braking power over driving power of one factor. Chosen (0500).
inline constexpr double kGreatestBrakeFactor = 1.3;
/// Standby power over the file's. Chosen (0500).
inline constexpr double kMostStandby = 5.0;
/// A dead gyro, heading or position shows where the wheels turn the body faster. Physical scale.
inline constexpr double kMovingYawRate_rad_s = 0.1;
/// The same of the wheels' travel. Physical scale.
inline constexpr double kMovingTravel_m_s = 0.1;
/// A dead voltage or wheel speed shows where the wheel turns faster. Physical scale.
inline constexpr double kTurningWheel_rad_s = 0.6;
/// A dead current or battery channel shows where its expected change is this share of friction or power.
/// Chosen.
inline constexpr double kLeastChange = 0.3;

// Values that no robot has. Bounds of single columns stand in checks/plausible.cpp.

/// Of a wheel's rim. Physical scale.
inline constexpr double kFastest_m_s = 20.0;
/// A reading this many times what the battery drives through a standing motor, or a wheel this many times as
/// fast as without a load, is in another unit. Chosen: windings are known better (kMostScale,
/// kMostMeasuredFactor), and slips of units are factors of 10 and more, of a reading that is near a third.
inline constexpr double kFarBeyond = 3.0;
/// Between samples, median. Physical scale.
inline constexpr double kLongestStep_s = 60.0;
/// Of an epoch clock: the year 2286. Derived: milliseconds since 1970 are above it, seconds below.
inline constexpr double kLatestClock_s = 1e10;
/// From rest to a wheel's greatest speed, at the steepest rise of the log. Physical scale: a robot needs
/// seconds.
inline constexpr double kLongestStart_s = 100.0;
/// And in more samples than this: a log with a sample each minute misses the start. Chosen.
inline constexpr double kLeastStartSteps = 10.0;
/// Of a wheel's greatest speed: a slower one stands. Chosen.
inline constexpr double kStandingShare = 0.1;
/// Ratio of the body's speed to that of its wheels: another robot's log. Physical scale.
inline constexpr double kOddRatio = 2.0;
/// Below this mean speed they are not compared. Physical scale.
inline constexpr double kMoving_m_s = 0.05;
/// Loggers of robots have longer sample periods. Physical scale.
inline constexpr double kShortestPeriod_s = 5e-4;

// What runs cannot show. They guard against names that no manoeuvre supports (0508).

/// A sample turns where the wheels differ by this share of their speeds. Physical scale.
inline constexpr double kTurningShare = 0.2;
/// A wheel that turns faster moves, a slower one stands. Physical scale.
inline constexpr double kMovingWheel_rad_s = 0.3;
/// Turns, reversing or standstill in fewer samples count as none. Chosen.
inline constexpr double kLeastManoeuvreShare = 0.01;

// Noise and calibration.

/// Samples over which a residual of heading or position changes: longer than the memory of its short noise,
/// so that only the walk of the encoders' noise makes longer ones change more. Chosen (0502).
inline constexpr std::ptrdiff_t kShortNoiseLag = 5;
/// See kShortNoiseLag; shorter than a run. Chosen (0502).
inline constexpr std::ptrdiff_t kLongNoiseLag = 30;
/// Least variance of that short noise over the mean square of the changes over kShortNoiseLag. Chosen (0502):
/// guards logs where the walk is all.
inline constexpr double kLeastShortNoise = 0.05;
/// A channel that changes less often tells no hold of its readings. Chosen: guards channels at rest.
inline constexpr std::size_t kLeastReadings = 20;
/// Part of the changes that are as far apart as the lower tenth of them, to a sample, where a channel holds
/// its readings. Chosen: the others lie beside a rest.
inline constexpr double kRegularReadings = 0.8;
/// Half of a channel's changes over the lower tenth: of steps to which it is rounded less, since they are all
/// alike. Chosen: noise has a factor of 5.
inline constexpr double kOfOneStep = 1.5;
/// Readings so many 1-sigma widths of the smoothing apart are seen one by one: those of a pose where they
/// are, those of a battery where what they read is steady, since a delay to second order no longer describes
/// them. Chosen (0500, 0501).
inline constexpr double kBlurredReadings = 2;
/// Least noise of a channel over what it reads. Derived: 12 bits of a signal that fills half its range.
inline constexpr double kResolution = 5e-4;
/// The same of voltages: a duty cycle is set, not sensed, and finer. Physical scale.
inline constexpr double kVoltageResolution = 2e-4;
/// Moment that the contacts hold on a straight line after a turn, over the moment of the robot's resistance
/// at half the track, 1-sigma. Physical scale: that of scrub.
inline constexpr double kUsualHeldMoment = 0.4;
/// Creep of a rubber tire times the mass that it carries, 1-sigma. Physical scale.
inline constexpr double kUsualCreep_kg_m_s_N = 2e-3;
/// Inverse square of the natural frequency with which a body swings on its tires and gears, 1-sigma: 4 Hz.
/// Physical scale.
inline constexpr double kUsualSwing_s2 = 1.6e-3;
/// Noise in the second derivative of an acceleration over its mean square, above which it shows no swing.
/// Chosen (0501): guards days of noisy encoders against a copy of their noise.
inline constexpr double kMostSwingNoise = 0.02;
/// Error of time stamps over the log's period, 1-sigma. Chosen (0503).
inline constexpr double kStampFraction = 0.06;
/// Delay of another instrument than the motors' driver over the period of its readings, 1-sigma. Derived:
/// half of it lies between a reading at the period's end and its mean (0501).
inline constexpr double kReadingDelay = 0.5;
/// Greatest change of a steady power over its root mean square. Chosen: a delay describes it.
inline constexpr double kSteadyPower = 0.02;
/// A calibration error further out, in its sigmas, is a finding. Derived: 0.3 % of normal errors.
inline constexpr double kCalibrationBox = 3.0;
/// Friction and the windings' resistance differ from run to run by this share at first; the fit re-estimates
/// it. Physical scale.
inline constexpr double kRunChange = 0.02;
/// Added to the file's dry friction for that share, where the file has none. Physical scale.
inline constexpr double kLeastChangingFriction_Nm = 1e-3;
/// The same of a gyro's bias. Physical scale.
inline constexpr double kRunGyroBias_rad_s = 1e-3;
/// The same of the standby power. Physical scale.
inline constexpr double kRunStandby_W = 0.05;

/// A battery's open-circuit voltage differs from the file's by this share, and falls by it in a run, 1-sigma:
/// it goes with the charge. Physical scale.
inline constexpr double kOpenCircuitChange = 0.05;

/// Prior width of a payload that no file states over the robot's mass, where the robot has no limit of it.
/// Physical scale.
inline constexpr double kUnstatedPayloadShare = 0.5;

// Weighing sets of effects, in log units of evidence.

/// Log prior odds against a first effect. Chosen.
inline constexpr double kEffectCost = 6.0;
/// Against each further one: a law's inexact form breeds ghosts. Chosen: at 12 practice
/// set p12 gets a third name that is not there.
inline constexpr double kFurtherEffectCost = 14.0;
/// Against an unknown term: the catalog holds what usually happens. Chosen.
inline constexpr double kUnknownCost = 16.0;
/// Sum of squares of a law beside unknown terms over what its set explains. Chosen: parts that overlap, not
/// ones that cancel.
inline constexpr double kLargestPart = 2.0;
/// Effects of a set. Chosen.
inline constexpr int kMostEffects = 4;
/// Unknown terms of a set. Chosen.
inline constexpr int kMostUnknowns = 2;
/// Effects and unknown terms of a set, and effects of a group that is named. Chosen.
inline constexpr int kMostMembers = 5;
/// Sets kept at each size of the search. Chosen.
inline constexpr int kBeamWidth = 14;
/// Sets whose small effects are tested again. Declared: bounds time.
inline constexpr std::size_t kMostReconsidered = 300;
/// Rounds of linearize, search, refit. Declared: ends a search that alternates between two sets.
inline constexpr int kRelinearizations = 4;
/// Log evidence needed to name an effect below the materiality floor. Chosen (0504).
inline constexpr double kSmallEffectEvidence = 10.0;
/// The same from fewer than kRunsForSmallEffects, firm effects alone. Derived: twice the above, as the
/// scatter of six runs is underestimated by that factor in one draw of four (chi-square of 5 below 2.7)
/// (0504).
inline constexpr double kSmallEffectEvidenceOfFewRuns = 20.0;
/// The same as kSmallEffectEvidence for pliable effects at just material size; grows as 1/sqrt(size). Chosen
/// (0504).
inline constexpr double kSmallPliableEvidence = 13.0;
/// Error of the model itself, the same in every run, over the materiality floor, 1-sigma: a tenth of what a
/// user would notice. The evidence for a smaller effect does not grow beyond it with the number of runs.
/// Declared.
inline constexpr double kModelError = 0.1;
/// Effects below this share of the materiality floor are not named. Chosen (0504): guards logs without noise.
inline constexpr double kLeastSize = 0.03;
/// Share of all evidence that inexact forms of the other effects make up. Chosen (0504): without it, practice
/// set p10 gets a second name.
inline constexpr double kShareOfFormError = 0.05;
/// Overlap from which on all of an effect may be the others' inexact form. Chosen (0504), with the above.
inline constexpr double kFullOverlap = 0.25;
/// Ridge on columns of length 1, for that overlap: forms that hardly differ. Chosen (0504).
inline constexpr double kOverlapRidge = 1e-3;
/// Prior width of an amplitude in sizes worth noticing. Chosen.
inline constexpr double kAmplitudePriorSteps = 4.0;
/// Share by which a law's strength usually varies with each form variable, 1-sigma. Chosen (0503).
inline constexpr double kFormSpread = 0.12;
/// A law's form further out, in its sigmas, is part of an unknown cause. Derived: 0.3 % of normal errors
/// (0505).
inline constexpr double kInexactForm = 3.0;
/// A law's form whose 95 % interval lies beyond this share of its strength is part of an unknown cause, too.
/// Chosen (0505).
inline constexpr double kSureForm = 0.2;
/// Speed in the middle of a form variable's scale. Physical scale.
inline constexpr double kUsualSpeed_m_s = 0.3;
/// The same of yaw rates. Physical scale.
inline constexpr double kUsualYawRate_rad_s = 0.5;
/// The same of payloads. Physical scale.
inline constexpr double kUsualPayload_kg = 5.0;
/// The same of accelerations. Physical scale.
inline constexpr double kUsualAcceleration_m_s2 = 0.2;
/// The same of the time of the day. Physical scale: a drive's temperature.
inline constexpr double kUsualTime_s = 200.0;
/// A fit is at its end where a further step is shorter than this, in standard deviations. Derived: such a
/// step adds 0.05 nats.
inline constexpr double kConvergedStep = 0.3;
/// Steps of a fit. Declared: ends one that alternates between two points.
inline constexpr int kMostFitSteps = 10;
/// Prior width of a shape parameter over its value. Chosen.
inline constexpr double kShapeSpread = 0.5;
/// Step of the scan for a region on the floor; its edges are known as well before a fit. Chosen.
inline constexpr double kRegionStep_m = 0.1;
/// Steps of that scan along an axis; those of longer floors are wider. Declared: bounds time.
inline constexpr double kMostRegionSteps = 400.0;
/// Samples inside of a region and outside. Chosen.
inline constexpr double kLeastSamplesOfRegion = 15.0;
/// Prior width of an unknown term over the amplitude that explains all residuals. Chosen.
inline constexpr double kUnknownPrior = 0.5;
/// Delays of the electrical channels that are sought, from. Physical scale.
inline constexpr double kEarliestReading_s = -0.2;
/// See kEarliestReading_s, to. Physical scale.
inline constexpr double kLatestReading_s = 0.4;
/// Step of that search; the fit refines the delay. Declared: bounds time.
inline constexpr double kDelayStep_s = 0.02;
/// Share of the windings' sum of squares that a delay must explain. Chosen.
inline constexpr double kNotableDelayGain = 0.15;
/// Longest filter of wheel speeds that is sought. Physical scale.
inline constexpr double kLongestFilter_s = 0.25;
/// Step of the delay beside it. Declared: bounds time.
inline constexpr double kFineDelayStep_s = 0.005;
/// Share of the sum of squares behind a delay that the filter must explain. Chosen: 0.33 to 0.94 on days with
/// a filter, at most 0.1 on others (0501).
inline constexpr double kNotableFilterGain = 0.25;
/// Share of the accelerations' sum of squares that currents and speeds do not follow: with less, noise of the
/// current passes for a filter, or for a part of one. Chosen: at most 0.017 on such days, else 0.05 (0501).
inline constexpr double kLeastOwnSlope = 0.03;

// Materiality: what a user would notice.

/// Change of energy or power, as a share. Declared.
inline constexpr double kMaterialEnergy = 0.01;
/// Of a battery. Declared.
inline constexpr double kMaterialVoltage_V = 0.1;
/// At a run's end. Declared.
inline constexpr double kMaterialHeading_rad = 0.03;
/// At a run's end, over the distance travelled. Declared.
inline constexpr double kMaterialPosition = 0.006;
/// Shorter runs count as this long for kMaterialPosition. Declared.
inline constexpr double kLeastTravelled_m = 0.5;
/// Of the electrical channels. Declared (0503: half a sample is a convention).
inline constexpr double kMaterialDelay_samples = 0.6;

// Unknown terms, and calibration constants beyond their uncertainty.

/// A smaller share of what is explained is not reported as a cause, nor preferred to a law. Declared.
inline constexpr double kLeastUnknownShare = 0.05;
/// Cosine of a calibration constant's signature with an effect's, to be that effect. Derived: numbers of one
/// law differ by the curvature of the model alone.
inline constexpr double kSameSignature = 0.99;
/// Increase of -2 log likelihood when constants are held within kCalibrationBox, from which on one is a
/// finding. Chosen (0503): guards the all-clear of runs without an effect.
inline constexpr double kLeastLossOfBox = 50.0;

// Names and groups.

/// Log evidence of real data over its face value. Chosen for calibrated probabilities.
inline constexpr double kScoreFlattening = 0.7;
/// -2 log likelihood ratio that tells two effects apart. Derived: 2 ln 20.
inline constexpr double kStandInLoss = 6.0;
/// An amplitude that is fewer sigmas outside of its accepted range may be inside. Derived: 95 %.
inline constexpr double kSigmasOutOfRange = 2.0;
/// Explanations compared with a named one. Declared: bounds time.
inline constexpr std::size_t kMostRivals = 100;
/// Laws that runs favour by turns, beside the one named. Declared: more are no answer.
inline constexpr std::size_t kMostLikelyRivals = 2;
/// Prior widths that leave an amplitude to the data. Chosen.
inline constexpr double kFreeAmplitude = 30.0;
/// A less likely effect, group or unknown term is not named; a group without a member as likely is ambiguous.
/// Chosen (benchmarks/diagnosis_race: nulls reach 0.61).
inline constexpr double kLeastProbabilityNamed = 0.7;
/// A less likely effect is not named for a calibration constant beyond its uncertainty. Chosen (0505).
inline constexpr double kLeastProbabilityOfConstant = 0.05;
/// A less likely effect is not listed. Declared.
inline constexpr double kLeastProbabilityRanked = 1e-4;
/// Effects listed. Declared.
inline constexpr std::size_t kLongestRanking = 12;
/// Share of sure names that were right. Calibrated by `./dev bench diagnosis_coverage`, its own cases.
inline constexpr double kSurest = 0.97;
/// The same from fewer than kRunsForSmallEffects, same command.
inline constexpr double kSurestOfFewRuns = 0.85;

// The next run.

/// Effects that one run is to tell apart. Declared: bounds time.
inline constexpr std::size_t kMostSeparated = 4;
/// Of the ranking, where an open verdict has no group. Declared.
inline constexpr std::size_t kMostOpenEffects = 3;
/// Rounds of changing one free parameter of the best manoeuvre. Declared: bounds time.
inline constexpr int kRunRefinements = 2;
/// Of standing still. Declared.
inline constexpr double kLongestStand_s = 60.0;
/// Of the standstill at which the payload changes. Declared.
inline constexpr double kLoading_s = 10.0;

// An all-clear.

/// Of simulated gaps, that the runs must show. Declared.
inline constexpr double kShareSeen = 0.9;
/// A normal quantity is below its mean plus this many sigmas with that probability. Derived.
inline constexpr double kSigmasOfShareSeen = 1.281552;
/// Runs that would not show a greater gap are too few. Declared.
inline constexpr double kGreatestUnseen_percent = 10.0;
/// An all-clear names effects whose gap of this size the runs would not show. Declared.
inline constexpr double kNotedUnseen_percent = 3.0;
/// Effects whose usual size changes less of the energy are no gap of energy. Chosen (0506).
inline constexpr double kLeastEnergyOfStep = 0.002;

// Held-out runs and the correction.

/// Held-out energy gap that a correction of other signals may add. Declared.
inline constexpr double kToleratedWorsening_percent = 0.05;
/// Share of another signal's held-out gap that such a correction must take away. Declared.
inline constexpr double kNotableShrink = 0.1;
/// Two parameters of a correction whose correlation is smaller are not listed together. Declared.
inline constexpr double kNotableCorrelation = 0.5;
/// A held-out gap above this many noise floors is more than noise. Chosen (0507).
inline constexpr double kFloorsLeft = 2.0;
/// A smaller held-out gap is not examined further. Chosen (0507).
inline constexpr double kMaterialGap_percent = 2.0;
/// Factor on kFloorsLeft and kMaterialGap_percent where nothing is named or fewer than kFewHeldOut runs
/// judge: the scatter is known less. Chosen: guards the all-clear of runs without an effect.
inline constexpr double kCautionFactor = 2.0;
/// The noise floor is at most this many times the scatter between runs. Chosen (0507): guards causes that no
/// law has.
inline constexpr double kScatterFactor = 2.0;
/// Another day's scatter changes the remaining gap by this many noise floors. Chosen (0504).
inline constexpr double kAnotherDay = 0.7;
/// Share by which an inexact form moves a law's mean strength. Chosen (0504).
inline constexpr double kLawInexactness = 0.025;
/// Of the diagnosis runs, to choose the ceiling's ridge. Chosen.
inline constexpr std::size_t kRidgeFolds = 4;

/// A part of the gap below this is none to tell: it prints as 0. Declared.
inline constexpr double kLeastShownShare = 1e-3;

// A run that no model of the others describes.

/// Its gap over that of the next run, under the fit of the others. Chosen: a run of a payload, a place or a
/// direction of its own has a law that explains it.
inline constexpr double kApart = 4.0;
/// The same under the fit of all runs, from which on the others are fitted alone: one run moves the fit.
/// Chosen.
inline constexpr double kDoubtedApart = 1.5;
/// Its gap over the mean power, at least. Declared.
inline constexpr double kLeastApart = 0.05;

// Cells of the gap, and phases of a motion.

/// Beyond this, small cells get no interval. Declared: bounds time.
inline constexpr std::size_t kManyCells = 40;
/// Of an axis: a small cell. Declared.
inline constexpr double kNegligibleShare = 0.01;
/// Width. Declared.
inline constexpr double kSpeedCell_m_s = 0.2;
/// Width. Declared.
inline constexpr double kTimeCell_s = 60.0;
/// The gap is averaged over this time before and after a sample. Chosen (0510): noise hides small gaps that
/// last.
inline constexpr double kGapWindow_s = 0.2;
/// Width of a square. Declared.
inline constexpr double kFloorCell_m = 1.0;
/// Of a full turn. Declared.
inline constexpr int kHeadingCells = 8;
/// Least part of the winding noise's variance that is the voltage's, where the current's takes most of it.
/// Chosen.
inline constexpr double kLeastVoltageNoise = 0.1;
/// A slower body stands. Physical scale.
inline constexpr double kStandstillAlong_m_s = 0.02;
/// The same of a wheel about the body's middle. Physical scale.
inline constexpr double kStandstillAcross_m_s = 0.01;
/// Wheel speed about the middle over the body's speed, from which on it spins. Declared.
inline constexpr double kSpinRatio = 3.0;
/// The same from which on it turns. Declared.
inline constexpr double kTurnRatio = 0.08;
/// Least speed about the middle of a turn, at kTurnRatio 0. Declared.
inline constexpr double kTurnAcross_m_s = 0.005;
/// A smaller change of speed is cruising. Declared.
inline constexpr double kCruise_m_s2 = 0.06;

// Runs with energies alone, beside the thresholds above.

/// Relative scatter of repeated runs where too few runs tell it. Chosen.
inline constexpr double kUsualScatter = 0.03;
/// The least that it is taken for: what a wattmeter and a stop watch repeat. Physical scale.
inline constexpr double kLeastScatter = 0.005;
/// Prior width of the coefficients of a smooth relative error. Chosen.
inline constexpr double kSmoothPriorSd = 0.2;
/// Scale of the payload in that error; that of the acceleration is kUsualAcceleration_m_s2. Physical scale.
inline constexpr double kPayloadOfSmoothError_kg = 10.0;
/// Runs that turn less are straight. Declared.
inline constexpr double kStraight_rad = 0.05;
/// Degrees of freedom from which a scatter is estimated. Chosen: guards fewer runs than variables.
inline constexpr double kLeastFreedom = 4.0;
/// Error of a braking rate or an entry speed that nobody recorded, 1-sigma, relative. Declared (0509).
inline constexpr double kMotionDoubtSigma = 0.2;
/// Effects of a set: a sum and a difference per run do not carry more. Chosen.
inline constexpr int kMostEffectsOfEnergies = 2;
/// Sigmas by which a large effect must move the data beyond calibration to be a candidate. Derived: 95 %.
inline constexpr double kVisibleSigmas = 2.0;
/// Of the runs, where the dataset says nothing about their use. Chosen (0509).
inline constexpr std::size_t kEnergyFolds = 4;

// A simulator's logs beside the robot's (0514).

/// Of the wheels' travel per time that a rest counts as, so that rests have an order. Chosen.
inline constexpr double kTravelOfRest = 1e-3;
/// Between the commands of two logs, at most. Declared.
inline constexpr double kLargestClockOffset_s = 5.0;
/// An offset that leaves less than this share of the commands' mean square is taken. Chosen.
inline constexpr double kBetterOffset = 0.9;
/// Of the wheel speeds (rms): alignments that differ by less are equally good. Chosen.
inline constexpr double kSameMotion = 0.01;
/// Of the wheel speeds (rms) after the best alignment: more is another motion. Declared.
inline constexpr double kOtherMotion = 0.5;

}  // namespace joulepath
