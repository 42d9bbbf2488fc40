//! The texts of a report in English.

use crate::report::language::words::Words;

/// Texts of the report itself.
pub(super) const WORDS: Words = Words {
    report: "Report",
    to: "to",
    yes: "yes",
    no: "no",
    none: "none",
    values: "values",
    page_of: "Page {page} of {n}",
    figure: "Figure",
    intro: "Case “{case}”, {date}. Computed with impactlab {version}. Every answer in this report \
        was computed from the case and the files that it names.",
    units_si: "Units: {units}. Angles and yaw rates are positive to the left.",
    units_us: "Units: {units}; roll stiffness and damping, rolling resistance, drag areas and the errors in section 7 \
        are in SI units. Angles and yaw rates are positive to the left.",
    language_note: "",
    notes: "Notes of the analyst",
    changed_notice: "Something is not as it was when the case was saved: {what}. The answers below are those \
        of now and may differ from those of then.",
    change_missing: "the file {path} is missing",
    change_changed: "the file {path} has changed",
    change_case: "the case file {path} itself was edited without the program",
    change_model: "the {network} “{name}” is another one",
    unanswered_notice: "Questions without an answer: {n} of {all}; why is said below.",
    no_answer: "No answer: {error}",
    no_answer_of: "{name}: no answer: {error}",
    variant: "Variant: {name}",
    variant_column: "Variant",
    all_variants: "all variants",
    alike: "The same in each of these variants: {values}.",
    beside_intervals: "{caption} (in brackets the interval of 90 %)",
    variants_beside: "The variants stand beside each other. Intervals of 50 % are in the answers that \
        “impactlab case run --json” gives.",
    not_answered_for: "Not asked, or without an answer: {names}.",
    inputs_same_as: "As in variant “{name}”, except for what the table says.",
    inputs_all_same: "As in variant “{name}”.",
    inputs_without: "Not in this variant: {list}.",
    annex: "Annex",
    section_opinion: "Opinion",
    section_answers: "Questions and answers",
    section_pictures: "Scenes and curves",
    section_inputs: "Inputs",
    section_evidence: "Evidence and fit",
    section_method: "Method",
    section_validity: "Validity and restrictions",
    section_validation: "Validation of the models",
    at_validation: "section 7",
    section_sensitivity: "Sensitivity",
    section_provenance: "Versions, seeds, files",
    section_log: "Log of the case",
    quantity: "Quantity",
    value: "Value",
    part_of: "Part",
    class: "Class",
    source: "Source and uncertainty",
    class_given: "given",
    class_measured: "measured",
    class_estimated: "estimated by rule",
    class_assumed: "assumed",
    no_intervals: "These figures have no interval: they follow from the values in section 3 as they stand, \
        whose uncertainty they do not carry.",
    title_impact: "Impact",
    title_simulate: "Motion by the 4DOF model",
    title_force: "Predicted force",
    title_motion: "Predicted motion",
    title_reconstruct: "Reconstruction",
    ask_impact: "Question: which impulse, changes of velocity and yaw rates does the collision “{name}” \
        bring about, by planar impact mechanics?",
    ask_simulate: "Question: how does the struck vehicle ({vehicle}) move after the impact “{name}”, by the \
        4DOF vehicle model?",
    ask_drive: "Question: how does the car ({vehicle}) move in “{name}”, by the 4DOF vehicle model?",
    ask_force: "Question: which contact force does the collision “{name}” bring about, by the force \
        network, and how sure is that?",
    ask_motion: "Question: where does the struck vehicle ({vehicle}) go after the impact “{name}”, by the \
        response network, and how sure is that?",
    of_other_mass: "{vehicle}, here of {mass}",
    ask_reconstruct: "Question: how fast were both cars in the collision “{name}” before the impact, by what \
        was found?",
    ask_single_car: "Question: how fast was the car of “{name}” at the start of the motion, by what was found?",
    ask_other: "Question: {kind}.",
    other_caption: "All that the answer says",
    struck_vehicle: "struck vehicle",
    striking_vehicle: "striking vehicle",
    impact_picture: "The impact from above: impulse and changes of velocity at first contact",
    friction_zones: "zones of their own friction",
    zone_value: "friction {friction}; corners (X; Y) {corners}",
    meaning_draws: "In each row nine of ten drawn vehicles lie in the interval of 90 %; only what the data sheet \
        leaves open is varied.",
    scene_picture: "Simulation from above, vehicles at the end",
    contact_picture: "Simulation in perspective, vehicles at the end of the contact",
    ground_not_drawn: "; the ground is not drawn: {why}",
    force_picture: "Contact force on the struck vehicle over time, {axes} axes",
    yaw_rate_picture: "Yaw rate of the struck vehicle over time",
    yaw_rate_alone_picture: "Yaw rate of the car over time",
    controls_picture: "{quantity} over time",
    vehicles_drawn: "vehicles drawn:",
    forces_drawn: "forces:",
    meaning_force: "Each value lies in its interval of 90 % with that probability, by the distribution of the force \
        network. Section 7 says how often such intervals held, for those quantities that were validated.",
    force_network: "force network",
    response_network: "response network",
    applicability: "The case lies partly outside of what the {network} has learned from: {share} of the \
        distribution is that of the network, the rest that of the physics alone.",
    applies: "The {network} counts in full: no part of the distribution is that of the physics alone.",
    force_forecast_picture: "Predicted force on the struck vehicle: size over time with its bands",
    meaning_motion: "Each value lies in its interval of 90 % with that probability, by the distribution of the response \
        network over the forces and vehicles that were drawn. Section 7 says how often such regions of the \
        position held.",
    meaning_motion_one: "Each value lies in its interval of 90 % with that probability, by the distribution of the response \
        network for this one force and vehicle, whose own uncertainty is left out. Section 7 says how often \
        such regions of the position held.",
    phases_text: "A phase of contact lasts from touch to parting, also while one vehicle pushes the other on; its impulse \
        and its Δv, by the contact force alone, are those of the whole phase, and not those of the force of the first \
        contact, which stands by itself.",
    learned_duration: "The response network has learned from motions of up to {time}; after that the forecast \
        goes on with the 4DOF model and its fitted effects.",
    forecast_scene_picture: "Forecast from above: paths, and density with the regions of 50 and 90 % at the end",
    forecast_paths_picture: "Forecast from above: paths; no density, since the vehicles meet again before the end",
    atlas_heading: "The case in the atlas of the PIT manoeuvre",
    atlas_text: "The atlas is a model study: {all} computed manoeuvres, checked against no measured PIT. It says how \
                 often something happens among those, is no evidence of what happened here, and calls no speed safe. \
                 The table is of {rows} of the {all}, which lie in the same cells as the case: {like}. They are \
                 averaged over: {averaged}. In {inside} of them both networks apply. In all of them the driver of the \
                 striking car turns in further, keeps the speed, and brakes once the struck car has turned.",
    atlas_outside: "The case lies outside of the atlas, which says nothing of it: {list}.",
    atlas_picture: "The case in the atlas of the PIT manoeuvre, a model study: probability of a turn by 90° or \
                    more. Across: {x}; up: {y}; held: {held}",
    atlas_table: "Outcomes of the computed manoeuvres in the cells of the case",
    atlas_other_networks: "The atlas was computed with other networks than those that answered here ({list}): what it \
                           says and the prediction may differ for that reason alone.",
    atlas_rest: "everything that is no axis of the atlas",
    atlas_nothing: "nothing",
    atlas_error: "Standard error",
    atlas_few: "too few",
    atlas_doubtful: "not to be relied upon",
    after_second_contact: "The vehicles meet again before the end, and that contact is not computed: where they go \
        after it has no probability, and the medians are those of a motion without it.",
    forecast_yaw_picture: "Forecast: heading of the struck vehicle over time with its bands",
    ask_hand: "Question: what does “{name}” give, computed by hand?",
    ask_replay: "Question: how did {vehicle} move up to the first contact, by speed and steering of its event data \
        recorder ({name})?",
    meaning_replay: "Each value lies in its interval of 90 % with that probability if the record is of this motion and \
        its errors are as they were drawn; nobody has measured how often such intervals hold.",
    draws_replay: "draws of the record:",
    replay_path_picture: "Path up to the first contact from above, with the band of 90 % of the draws across it",
    replay_picture: "{quantity} on the clock of the recorder: recorded and replayed, with the band of 90 %",
    meaning_hand: "Each value lies in its interval of 90 % with that probability if the method holds, the inputs are as \
                   uncertain as they say, and depend on each other no more than the notes say.",
    meaning_posterior: "Each value lies in its interval of 90 % with that probability, given the evidence, if the assumptions \
        of section 3 and the models of section 5 hold.",
    meaning_doubtful: "These intervals{courses} are not to be relied on: see the warnings in section 6 ({badges}).",
    doubtful_figures: "These figures{courses} are not to be relied on: see the warnings in section 6 ({badges}).",
    doubtful_courses: ", and the probabilities of the courses of events,",
    too_few_particles: "No interval is given: the sample is equivalent to too few independent draws, or the run was \
        stopped before the evidence had its full weight, so that the ends of an interval would rest on single \
        draws. Ask again with more particles, and let the run end.",
    held_when_tried: "; when tried{known}, such intervals held in {share} of {n} cases",
    with_everything_known: " with all of the evidence known",
    too_narrow: "Take these intervals of 90 % as too narrow, since they held too seldom when they were tried (section 7): \
        {list}.",
    too_narrow_item: "{name}, in {share} of {n} cases{known}",
    particles: "particles:",
    simulated_motions: "simulated motions:",
    ess: "effective sample size of all motions, from which the particles are taken:",
    log_evidence: "log evidence:",
    reconstruction_cars: "Reconstruction from above: a motion of median speed with its tire marks, the struck car at \
        its end, over what was found",
    single_car: "Reconstruction from above: a motion of median speed with its tire marks, the car at its end, over \
        what was found",
    reconstruction_picture: "Reconstruction from above: possible paths over what was found",
    marginal_picture: "{quantity}: how likely it is without the evidence and with it",
    fit_text: "p is the probability that measurement and model err by more than they do here; an item \
        below {level} counts as unexplained.",
    left_out_text: "The speed without each part of the evidence in turn. The chance to lie so far off is the \
        probability with which the other parts expect it as far off as it was found, to either side, or farther; what \
        stands there is an upper bound: the smallest one of its items times their number. “≤ 1” says nothing: no \
        item of the part is a surprise, which does not prove that the part is right. A part that pulls the answer \
        towards itself seems to be explained by that very answer; here it is therefore left out of it.",
    several_courses: "More than one course of events is possible. Each has figures of its own in section 4; those \
        over all of them, below, may be true of none.",
    hinges_text: "A line through the particles by least squares says by how much a speed moves on the average \
        if one quantity is larger by so much, given the evidence; ± is the standard error of the line. The \
        friction of the road always stands there, others where the line is clear of chance.",
    modes_text: "± is the standard error by the number of particles. Courses of less than 1 % are left \
        out.",
    no_evidence: "No question of this case rests on evidence that was found: there is nothing to fit.",
    mark_value: "{n} points from {first} to {last}, each ± {sigma}",
    marks_computed_text: "A wheel marks the ground where it is locked, or slides sideways by more than {slip}, at \
        more than {speed}. The simulation of the vehicle itself leaves these marks, not those drawn from its data sheet.",
    marks_compared_text: "Each found mark stands beside the nearest one that its wheel leaves in one motion, that of a particle \
        of median speed; the distances are those of places on the found mark to the computed one.",
    prior: "prior distributions, before the evidence",
    uniform: "between {low} and {high}, each value equally likely",
    normal_cut: "normal, {value}, cut off at {low} and {high}",
    log_normal_cut: "log-normal, median {median}, σ of the logarithm {sigma}, cut off at {low} and \
        {high}",
    source_prior_given: "prior; given with the evidence, or by the chosen vehicle",
    source_prior_measured: "prior; measured, by the evidence",
    source_prior_rule: "prior; rule of the data sheet with its scatter",
    source_prior_drag: "prior; rule from the drag of locked wheels, which is compared itself",
    source_prior: "prior; default of the program",
    source_evidence_sigma: "evidence",
    source_default_sigma: "evidence; ± is that of the program, where the evidence says none",
    source_program: "default of the program",
    decision_prior: "with a probability of {share}",
    decision_by_number: "each of the two wheels near the damage with a probability of {share}, else none",
    source_evidence: "evidence",
    source_question: "question",
    source_question_sigma: "question; ± is that of the program, where the question says none",
    source_file: "file, see section 9",
    follows_from_sheet: "data sheet, or follows from the estimates below",
    inputs_text: "“Given” is what the question or the evidence says without a standard deviation, settings \
        of the computation included; “measured” has a standard deviation (±) or is a bound of a \
        record; “estimated by rule” follows from other values by a rule with known scatter; \
        “assumed” is what the program \
        chose, since nobody stated it.",
    inputs_caption: "{name}: {group}",
    inputs_said: "{caption}; as stated in the question",
    inputs_assumed: "assumed by the program",
    inputs_not_used: "given and not used by an answer",
    inputs_left: "Left at the defaults of the program: {values}.",
    validity_text: "What the models of the opinion leave out is said there. Each restriction that the \
        program found follows, with its sentence and a remedy.",
    validity_by_hand: "The condition under which each calculation by hand holds stands in section 1. Each restriction \
        that the program found follows, with its sentence and a remedy.",
    validity_models: "The other models leave out:",
    badges_caption: "Restrictions of the answers",
    restriction: "Restriction",
    sentence: "What it says",
    remedy: "Remedy",
    holds_for: "Applies to",
    no_badges: "The program found nothing that restricts the answers.",
    warning: "warning",
    note: "note",
    allowed_range: "{quantity}: {value}, without restriction {range}",
    at_least: "at least {low}",
    at_most: "at most {high}",
    remedy_outdated: "Ask again.",
    remedy_outside_domain: "Use a value inside the range, rely on the physics beside it, or train a network on such \
        collisions.",
    remedy_implausible_contact: "Check contact point, side and velocities; use the momentum solution.",
    remedy_disagreement: "Treat both answers as possible; look for what decides between them.",
    remedy_other_vehicle: "Say why the vehicle of the collision differs from the one that is named \
                           (passengers, load), or give the collision the values of that vehicle.",
    remedy_overlap: "Move the vehicles apart until their outlines touch, or give the contact point.",
    remedy_second_contact: "Use the motion up to the second contact only.",
    remedy_contact_not_ended: "Use a record that goes on until the force is zero.",
    remedy_doubtful_data: "Look at the file at the place that is named, or take another recording.",
    remedy_energy_gain: "Check the parameters of the vehicle; do not use the motion after this.",
    remedy_wheel_lift: "Treat the motion after this as approximate: lifted wheels carry no force.",
    remedy_roll_limit: "Do not use the motion after this: a rollover is not simulated.",
    remedy_not_at_rest: "Ask until rest, or with a longer duration.",
    remedy_evidence_unexplained: "Check this item and its standard deviation; consider another course of events.",
    remedy_few_particles: "Ask again with more particles.",
    remedy_few_draws: "Ask again with more draws.",
    remedy_several_courses: "Use the figures of each course of events; look for evidence that decides between them.",
    remedy_driver_open: "Say whether the driver brakes, steers or lets the vehicle roll, or show the answer for each.",
    remedy_hardly_validated: "Report the interval with this reservation.",
    remedy_no_interval: "State the standard deviation of each input.",
    remedy_left_out: "Look at the cases or draws that are left out.",
    remedy_trained_on: "Judge the network by cases that it has not seen.",
    remedy_assumed: "Give the value if it is known.",
    remedy_not_used: "Where it matters, ask by a method that uses it.",
    sources: "Sources",
    number: "No.",
    source_title: "Source",
    axes_text: "Axes are those of ISO 8855: x forward, y to the left, yaw positive to the left. World \
        axes are those of the scene; those of a reconstruction begin at the CG of the struck car \
        at first contact, X along its heading. Principal directions of force are degrees \
        clockwise from straight ahead, where the force comes from. Intervals leave out as much \
        below as above.",
    axes_single_car_text: "Axes are those of ISO 8855: x forward, y to the left, yaw positive to the left. World \
        axes of the reconstruction of a single car are those in which the evidence was measured. Intervals leave \
        out as much below as above.",
    axes_driven_text: "Axes are those of ISO 8855: x forward, y to the left, yaw positive to the left. World axes are \
        those of the scene.",
    method_impact: "Planar impact",
    method_impact_text: "Both vehicles are rigid bodies in the plane that exchange one impulse at one contact \
        point, in no time. Momentum and angular momentum are conserved; the normal component \
        follows from the coefficient of restitution, on the normal component or from the common \
        velocity, the tangential component from the condition that the contact points do not \
        slide, bounded by the friction limit. The energy that is lost is the difference of \
        kinetic energies.",
    limits_impact: "The impact is instantaneous, at one point, without a moment there; tire forces during \
        the contact are neglected. Restitution and friction limit are inputs.",
    method_four_dof: "4DOF vehicle model",
    method_four_dof_text: "The struck vehicle moves along, across, in yaw and in roll on a flat road. The lateral \
        force of each tire saturates with the slip angle and falls to sliding friction beyond \
        it; vertical loads shift with the accelerations; wheels roll freely, turn against a \
        brake or are locked. The impact enters as a force over time at the contact point. \
        Equations are integrated by the Runge–Kutta method with a fixed step, which is divided \
        for vehicles with faster modes.",
    limits_four_dof: "Pitch, heave, tire relaxation, aligning moments and suspension kinematics are left out; \
        the road is flat; a wheel has the friction of the road, or that of the zone it is in. A lifted wheel or a roll beyond 15° \
        is flagged; a rollover is not simulated. Where one vehicle is followed by itself, a second contact \
        is flagged and not computed.",
    method_four_dof_alone: "4DOF vehicle model of a single car",
    method_four_dof_alone_text: "The car moves along, across, in yaw and in roll. The lateral force of each tire \
        saturates with the slip angle and falls to sliding friction beyond it; vertical loads shift with the \
        accelerations; wheels roll freely, turn against a brake or are locked. Equations are integrated by the \
        Runge–Kutta method with a fixed step, which is divided for vehicles with faster modes.",
    limits_four_dof_alone: "Pitch, heave, tire relaxation, aligning moments and suspension kinematics are left out; \
        the road has one slope; a wheel has the friction of the road, or that of the zone it is in. A rollover is \
        not simulated.",
    method_contact: "Contact of two outlines",
    method_contact_text: "Both vehicles are followed together. Their outlines, rectangles with rounded corners, are cut \
        into elements of {element}; where they overlap, the elements of both are pressed together in series. The load of an \
        element grows linearly over an elastic branch to A and then by B times the crush, unloads along a steeper line, and \
        leaves a dent; friction acts along the face that is entered. A and B follow from class and mass by rule, with a \
        scatter of 25 to 40 %. Where the force of the first contact is known or predicted, the loads are scaled so that the \
        law takes the same work, and the law takes over at its end. While the vehicles touch, both are integrated by the \
        leapfrog method, and by the Runge–Kutta method while they are apart. Each draw takes a stiffness, friction, recovery, tires, \
        drivers and systems of its own.",
    limits_contact: "One place of contact at a time on each face, at one height. Wheels that hook, bodies that climb on each \
        other and parts that tear off are left out. Near the border between coming free and spinning small causes decide.",
    method_force: "Force network",
    method_force_text: "Two rigid cars whose skins crush until hard structures behind them meet give a force \
        over time; its laws are fitted to the training cases, and regressions on the same cases \
        are averaged with it. A neural network around this centre predicts the distribution of \
        the whole curve as a mixture, calibrated once on training cases. Outside of what it \
        learned from, the momentum solution with its measured errors takes its place.",
    limits_force: "The shipped one learned from 349 simulated impacts against the flanks of two saloons and, in a fifth of them, an SUV, \
        which close at up to {fast}; the absolute force level may be off by some 40 %. Which of these bodies was struck \
        is open unless it is said. It knows no size of the vehicles, no restitution and no friction between them.",
    method_response: "Response network",
    method_response_text: "Each step of the motion is one of the 4DOF model with a bounded acceleration added: \
        effects of known form with learned strengths, and a remainder by a neural network. \
        Whole motions are followed with the forces and vehicles that were drawn in turn, at least 240 where one \
        vehicle is followed by itself; what the network leaves uncertain is drawn for each. Outside of what it \
        learned from, the 4DOF model with its measured errors takes its place.",
    limits_response: "The shipped one learned from simulated motions of 88 cars of up to 12 s. The distance over which \
        a car rolls out has not been compared with a record.",
    method_reconstruction: "Reconstruction from evidence",
    method_reconstruction_text: "Everything that is not known (speeds, heading, contact, friction, masses, braking, …) \
        has a prior distribution. For each drawn set of values the \
        impact and the motion to rest are computed, and weighed by how well they go with what \
        was found, with the standard deviation of each measurement and an error of the model \
        that grows along the path. A sequential Monte Carlo sampler draws from the prior, then \
        from mixtures of normals that follow the evidence step by step, and weighs every draw by \
        the density that it came from; the standard error of probabilities follows from the \
        weights, the fit of each item from realized discrepancies.",
    limits_reconstruction: "Impact by momentum with restitution and friction, motion by the 4DOF model; the networks \
        take no part in it. Speed and heading of the striking car rest largely on what is \
        assumed of them. A motion is followed for 40 s.",
    method_single_car: "Reconstruction of a single car",
    method_single_car_text: "Everything that is not known (speed, sideslip angle and yaw rate at the start, friction, \
        braking, steering, …) has a prior distribution. For each drawn set of values \
        the motion from the start to rest is computed, and weighed by how well it goes with what was found, with \
        the standard deviation of each measurement and an error of the model that grows along the path. A \
        sequential Monte Carlo sampler draws from the prior, then from mixtures of normals that follow the evidence \
        step by step, and weighs every draw by the density that it came from.",
    limits_single_car: "Motion by the 4DOF model with front wheels that are held at one angle; the networks take no \
        part in it. A driver who steers to and fro or lets the brake go is left out. An anti-lock system holds the \
        slip near the peak of the friction and leaves no marks. A motion is followed for 40 s.",
    validation_single_car: "Cars that this program simulated with its own equations of motion. No real one was tried.",
    method_sheet: "Vehicle data by rule",
    method_sheet_text: "What a data sheet does not state follows from the rest by rules with a scatter, each \
        named with its source in section 3. Where vehicles are drawn, each open quantity is \
        drawn from its scatter.",
    limits_sheet: "Inertia, CG height and axle loads rest on measured vehicles of 1971 to 2005; suspension \
        and tires on 13 multibody cars, which are plausible and not measured.",
    validation_text: "These numbers are not of this case: they say how the models did where the truth was \
        known. The data are simulations, not measurements; no real collision was tried. Source: \
        docs/VALIDATION.md of the program, with the command of each table.",
    other_networks: "Answered by other networks than the default ones: {list}. Limits of the method and validation in \
        this report are of the default ones, which come with the program: what they learned from and how they did. \
        Of these networks they say nothing: `impactlab evaluate` measures them.",
    validation_impact: "Against finite-element runs of blows against a flank that close at {slow} to {middle}. Not \
        tried were higher closing speeds, at which restitution is smaller, blows against front or rear, walls and \
        poles.",
    table_impact: "Error of the impulse vector, median (mean), %",
    validation_four_dof: "Against a multibody model of the same car, on which its parameters were measured, over 4 s. Of \
        fifteen cars of which only the data sheet was known it erred more: by 1.13 m in the mean over the first 4 s, and \
        by 0.68 m in the median, on 180 motions.",
    table_four_dof: "Distance from the reference path",
    validation_force: "The shipped one, against 25 finite-element runs that it has not seen, which close at {slow} to \
        {middle}; intervals of 50 % are too wide there. Of 61 others, which close at up to {fast}, intervals of 90 % held 89 % of the impulses, \
        87 % of the peaks and 95 % of the durations; it erred there by 18 % of the impulse in the mean, and by 13 % in \
        the median.",
    table_force: "Errors, median (mean), %",
    table_force_coverage: "Share of the true values inside the intervals, %, ± standard error",
    validation_response: "The shipped one, against 371 simulated motions of 31 cars that the network has not seen, each by its \
        data sheet: error over 4 s and at the end, up to 12 s; shares of instants and ends inside the regions. No \
        real motion was tried.",
    validation_contact: "95 simulated pairs of multibody cars, 84 of them PIT manoeuvres; the law was fitted to half of \
        them. There it was used from the first touch on, without the force network, and what the drivers did was known. \
        Of three cars that were hit at a right angle and four that were hit from behind the regions along the path were \
        too narrow. No wall, no pole and no real collision was tried.",
    table_contact: "Error over 4 s and at the end, m, turns that were right, and shares of instants and ends inside the \
        regions",
    table_response: "Errors, m, and coverage",
    validation_reconstruction: "40 simulated rear-quarter impacts on one multibody car of three masses; 20 of them were looked at while the method was set (“tuning”). No real \
        collision was tried.",
    measured_on: "measured on",
    table_reconstruction: "Share of the true values inside the intervals, % (bounds of 95 % confidence), and errors; everything known. Other runs: cases of both halves whose finite-element run is not among those that the prior of restitution and friction was fitted to",
    table_without_recorder: "The same without the event data recorder",
    table_rest_alone: "The same with the rest poses, damage, masses and friction alone",
    validation_sheet: "The rules carry the scatter of the vehicles that they were made from; it is told beside \
        each estimate.",
    no_methods: "Nothing was answered by a model.",
    method_by_hand: "The equation of each calculation by hand, its condition and its sources stand in section 1. \
        Intervals leave out as much below as above.",
    validation_by_hand: "The tests of the program compare the equations with exercises whose answers are published. How \
        often the intervals of such calculations held was not counted.",
    no_sensitivity: "No answer of this case has a measure of what it depends on: its questions draw nothing, \
        or nothing that they draw moves the result by more than chance.",
    provenance_caption: "Answers",
    answer: "Answer",
    version: "Version",
    seeds: "Seeds and draws",
    no_draws: "nothing drawn",
    files_caption: "Files that the case uses, as they are now",
    file: "File",
    bytes: "Bytes",
    sha256: "SHA-256",
    no_files: "The case uses no files.",
    state: "State",
    unchanged: "as saved",
    new_file: "not recorded before",
    missing: "missing",
    changed: "changed",
    models_caption: "Trained networks that answered",
    network: "Network",
    name: "Name",
    no_models: "No trained network answered.",
    reproduce_text: "The same version with the same files, seeds and settings gives the same numbers on the same \
        kind of processor; another one may round the last digits differently, which shifts draws. A \
        report of the same case with the same date has the same bytes.",
    case_saved_by: "The case was saved by version {version}; this report was made by version {now}.",
    case_file: "Case file {path}: {bytes} bytes, SHA-256 {sha256}; {state}.",
    case_as_saved: "its content is what the program saved",
    case_edited: "it was edited since the program saved it",
    case_without_seal: "it has no seal of the program: it was written by hand or by an earlier version",
    case_in_no_file: "The case itself was not saved to a file.",
    log_caption: "What was done and when, UTC",
    time: "Time",
    event: "Event",
    no_log: "The case has no log.",
    no_pictures: "No answer has a picture.",
    not_drawn: "This build draws no pictures: {caption}",
    scene_alt: "{title}. Cars on the ground. Shown: {names}.",
    axes_alt: "{title}. Horizontal axis: {x}. Vertical axis: {y}. Shown: {names}.",
    car_alt: "At {time} {name}: X {x}, Y {y}, heading {heading}.",
    line_alt: "{name}: from {y0} at {x0} to {y1} at {x1}; least {low} at {at_low}, greatest {high} at {at_high}.",
    place_alt: "{name}: from ({x0}; {y0}) to ({x1}; {y1}).",
    band_alt: "{name}: {low} to {high} at {x}.",
    instant_alt: "{name}: at {x}.",
    picture_elsewhere: "The picture is in the PDF of this report.",
    noted: "Note: {note}.",
    seed: "seed",
    domain_caption: "Domain of the networks",
    signature: "Place, date, signature: ______________________________",
};
