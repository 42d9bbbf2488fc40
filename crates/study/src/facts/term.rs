//! What the facts of an answer are called, in each language. One table, and as long as there are names.

use serde::Serialize;

use impactlab_core::units::Language;

macro_rules! terms {
    ($($name:ident: $en:literal, $de:literal $(, $hint:literal)?;)+) => {
        /// What a fact, a column or a table of facts is called.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Term {
            $(#[doc = concat!("`", $en, "`")] $name,)+
        }

        impl Term {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            /// The name in a language.
            pub const fn label(self, language: Language) -> &'static str {
                match (self, language) {
                    $((Self::$name, Language::En) => $en, (Self::$name, Language::De) => $de,)+
                }
            }

            /// What it means, where the name does not say it.
            pub const fn hint(self) -> Option<&'static str> {
                match self {
                    $($(Self::$name => Some($hint),)?)+
                    _ => None,
                }
            }
        }
    };
}

terms! {
    // Columns.
    Quantity: "quantity", "Größe";
    Value: "value", "Wert";
    Median: "median", "Median", "As likely exceeded as not";
    StruckVehicle: "struck vehicle", "gestoßenes Fahrzeug";
    StrikingVehicle: "striking vehicle", "stoßendes Fahrzeug";
    // The answer to a forecast.
    TheAnswer: "The answer", "Die Antwort";
    WillItSpin: "Will it spin?", "Gerät es ins Schleudern?";
    TurnedQuarter: "turned by 90° or more at the end with", "am Ende um 90° oder mehr gedreht mit";
    TurnedHalf: "by 180° or more with", "um 180° oder mehr mit";
    WhereDoesItStop: "Where does it stop?", "Wo kommt es zum Stillstand?";
    RestsIn: "it comes to rest in", "es kommt zum Stillstand in";
    RestsAfter: "it is at rest after", "es steht nach";
    MovesAfter: "not within the forecast: it still moves after",
        "nicht innerhalb der Vorhersage: es bewegt sich noch nach";
    At: "at", "bei";
    AfterPath: "after a path of", "nach einem Weg von";
    WithSpeed: "at a speed of", "mit einer Geschwindigkeit von";
    OthersStillMove: "the others counted with where they are when they are followed no further",
        "die übrigen gezählt mit dem Ort, bis zu dem sie verfolgt werden";
    AfterSecondContact: "without a probability, since a second contact comes before and is not computed",
        "ohne Wahrscheinlichkeit, da ein zweiter Kontakt vorausgeht, der nicht berechnet ist";
    IntoNextLane: "Does it cross into the next lane?", "Gerät es auf den nächsten Fahrstreifen?";
    WithChance: "with", "mit";
    NoOtherLane: "in no draw does a vehicle come over a part of the site on which it was not",
        "in keiner Ziehung gerät ein Fahrzeug auf einen Teil des Geländes, auf dem es nicht war";
    LanesNotCounted: "not counted: that takes a site with lanes, and both vehicles followed",
        "nicht gezählt: dazu braucht es ein Gelände mit Fahrstreifen und beide Fahrzeuge";
    HowSure: "How sure is that?", "Wie sicher ist das?";
    HeldAtWorst: "in tests, intervals of 90 % held at worst in",
        "bei der Erprobung trafen Bereiche von 90 % im ungünstigsten Fall zu in";
    ComputedMotions: "computed motions", "berechneten Bewegungen";
    HeldNotCounted: "it was not counted how often intervals of such forecasts hold",
        "wie oft Bereiche solcher Vorhersagen zutreffen, wurde nicht gezählt";
    WhatWouldChangeIt: "What would change it?", "Was würde es ändern?";
    NothingDrawn: "not computed: no vehicles and roads were drawn",
        "nicht berechnet: Fahrzeuge und Fahrbahnen wurden nicht gezogen";
    TooFewDrawn: "not known: too few vehicles and roads were drawn",
        "nicht bekannt: zu wenige Fahrzeuge und Fahrbahnen wurden gezogen";
    AnswerNumbers: "The answer in numbers", "Die Antwort in Zahlen";
    // The force of the first contact by each method.
    ForceByMethod: "Force of the first contact by each method; in brackets the intervals of 90 %",
        "Kraft des ersten Kontakts nach jedem Verfahren; in Klammern die Bereiche von 90 %";
    ByNetwork: "force network", "Kraftnetz";
    ByMomentum: "momentum solution", "Impulslösung",
        "Its intervals are the errors that it was measured to have on 200 finite-element runs; it has no course of the force";
    ByRecord: "record", "Aufzeichnung";
    StruckDeltaV: "Δv of the struck vehicle", "Δv des gestoßenen Fahrzeugs", "Impulse over mass";
    RecordImpulse: "size of the impulse, record", "Betrag des Impulses, Aufzeichnung";
    Record: "the record", "der Aufzeichnung";
    WhereAtRest: "where it comes to rest", "wo es zum Stillstand kommt", "Of the CG, from the place of the first contact";
    WhereAtRestOrLimit: "where it is at rest, or when it is followed no further", "wo es stillsteht oder nicht weiter verfolgt wird", "Of the CG, from the place of the first contact";
    WhereAtEnd: "where it is when the forecast ends", "wo es am Ende der Vorhersage ist", "Of the CG, from the place of the first contact";
    StruckComesOver: "the struck vehicle comes over", "das gestoßene Fahrzeug gerät auf";
    StrikingComesOver: "the striking vehicle comes over", "das stoßende Fahrzeug gerät auf";
    StruckEndsOver: "the struck vehicle ends on", "das gestoßene Fahrzeug endet auf";
    StrikingEndsOver: "the striking vehicle ends on", "das stoßende Fahrzeug endet auf";
    StruckIsOver: "the struck vehicle is last on", "das gestoßene Fahrzeug ist zuletzt auf";
    StrikingIsOver: "the striking vehicle is last on", "das stoßende Fahrzeug ist zuletzt auf";
    MovedFirstBy: "the force of the first contact is that of", "die Kraft des ersten Kontakts folgt";
    ForceNetwork: "the force network", "dem Kraftnetz";
    ContactLaw: "the contact law", "dem Kontaktgesetz";
    LawAndMomentum: "the contact law and the momentum solution, half of the draws each",
        "je zur Hälfte der Ziehungen dem Kontaktgesetz und der Impulslösung";
    MomentumSolution: "the momentum solution", "der Impulslösung";
    ImpulsesVerdict: "the impulses of force network and momentum solution",
        "die Impulse von Kraftnetz und Impulslösung";
    EndsVerdict: "the ends by network and 4DOF model", "die Enden nach Netz und 4DOF-Modell";
    HingesOn: "the end depends on", "das Ende hängt ab von",
        "Estimates of vehicle and road with 10 % or more of the variance of place or heading at the end";
    HingesOnNone: "no single estimate of vehicle or road with 10 % or more; the rest is force, contact and drivers",
        "keinem einzelnen Schätzwert von Fahrzeug oder Fahrbahn zu 10 % oder mehr; das Übrige sind Kraft, Kontakt und Fahrer";
    OfPlace: "of the variance of the place", "der Varianz des Orts";
    OfHeading: "of that of the heading", "der des Winkels";
    // The impact.
    Impact: "Contact and impulse; the impulse acts on the struck vehicle, world axes",
        "Kontakt und Impuls; der Impuls wirkt auf das gestoßene Fahrzeug, Weltachsen";
    Restitution: "restitution", "Stoßziffer";
    FrictionLimit: "friction limit of the contact", "Reibbeiwert im Kontakt";
    AlwaysSliding: "always sliding", "stets gleitend";
    CriticalRatio: "critical impulse ratio", "kritisches Impulsverhältnis",
        "The smallest friction limit with which the vehicles do not slide";
    ShareOfCritical: "friction limit over the critical impulse ratio",
        "Reibbeiwert zum kritischen Impulsverhältnis";
    ContactNormal: "contact normal, world axes", "Kontaktnormale, Weltachsen";
    StruckSurface: "struck surface", "gestoßene Fläche";
    AsGiven: "as given", "wie angegeben";
    Overlap: "overlap of the outlines", "Überdeckung der Umrisse";
    Gap: "gap between the outlines", "Abstand der Umrisse";
    Touch: "none, they touch", "keine, sie berühren sich";
    Regime: "regime", "Stoßart";
    ClosingVelocity: "closing velocity", "Annäherungsgeschwindigkeit";
    ImpulseOnStruck: "impulse on the struck vehicle", "Impuls auf das gestoßene Fahrzeug";
    ImpulseNormal: "normal impulse P_n", "Normalimpuls P_n";
    ImpulseTangential: "tangential impulse P_τ", "Tangentialimpuls P_τ";
    EnergyLoss: "energy lost in the contact", "Energieverlust im Stoß";
    VehiclesAfterImpact: "Both vehicles after the impact, world axes",
        "Beide Fahrzeuge nach dem Stoß, Weltachsen";
    StruckAfterImpact: "Struck vehicle after the impact, world axes",
        "Gestoßenes Fahrzeug nach dem Stoß, Weltachsen";
    DeltaV: "change of velocity Δv", "Geschwindigkeitsänderung Δv";
    VelocityAfter: "velocity after the impact", "Geschwindigkeit nach dem Stoß";
    YawRateAfter: "yaw rate after the impact", "Gierrate nach dem Stoß";
    YawRateChange: "change of the yaw rate", "Änderung der Gierrate";
    Pdof: "principal direction of force", "Hauptstoßrichtung (PDOF)",
        "Clockwise from straight ahead, where the force comes from";
    ClockDirection: "the same as an hour of the clock", "dieselbe als Uhrzeit";
    None: "none", "keine";
    // The simulation.
    Motion: "Motion with each input at its median", "Bewegung, jede Eingangsgröße mit ihrem Median";
    Equations: "equations of motion", "Bewegungsgleichungen";
    Integration: "integration", "Integrationsverfahren";
    RoadFriction: "friction of the road", "Reibbeiwert der Fahrbahn";
    SpeedBeforeSkid: "speed before the skid", "Geschwindigkeit vor der Bremsspur";
    RoadGrade: "grade of the road along X", "Längsneigung der Fahrbahn entlang X";
    RoadCrossSlope: "cross slope of the road", "Querneigung der Fahrbahn";
    FrictionZones: "zones of their own friction", "Bereiche mit eigenem Reibbeiwert";
    Duration: "duration", "Dauer";
    ForceFile: "file of the force", "Kraftdatei";
    ForceAxes: "axes of the force", "Achsen der Kraft";
    ForceSampling: "samples of the force", "Werte der Kraft";
    YawMoment: "yaw moment", "Giermoment";
    PeakForce: "peak force", "größte Stoßkraft", "Largest size of the force, a mean over 1 ms";
    Contact: "contact", "Kontakt";
    MomentumSurface: "momentum solution with", "Impulslösung mit";
    DeltaVContact: "Δv over the contact, tires included", "Δv über den Kontakt, mit Reifenkräften";
    EndPosition: "position at the end", "Lage am Ende", "Of the CG, world axes";
    Distance: "length of the path", "Weglänge", "Of the CG";
    FinalHeading: "heading at the end", "Gierwinkel am Ende";
    LargestTurn: "largest change of heading", "größte Änderung des Gierwinkels";
    FinalSpeed: "speed at the end", "Geschwindigkeit am Ende";
    AtRest: "at rest", "Stillstand";
    StillMoving: "no, still moving at the end", "nein, am Ende noch in Bewegung";
    AtRestAfter: "at rest after", "Stillstand nach",
        "After the force, speed and yaw rate stay below 0.05 m/s and 0.01 rad/s to the end";
    RestPosition: "position at rest", "Lage im Stillstand";
    DistanceToRest: "distance to rest", "Auslaufstrecke", "Along the path of the CG";
    HeadingAtRest: "heading at rest", "Gierwinkel im Stillstand", "To the left of the X axis";
    AverageError: "mean distance from the recorded path", "mittlerer Abstand zur aufgezeichneten Bahn";
    FinalError: "distance from the recorded end", "Abstand zum aufgezeichneten Ende";
    Marks: "Tire marks that the simulation leaves", "Reifenspuren, die die Simulation hinterlässt";
    MarkCause: "by", "durch";
    MarkLength: "length", "Länge";
    FromTime: "from, time", "von, Zeit";
    FromPlace: "from (X; Y)", "von (X; Y)";
    ToTime: "to, time", "bis, Zeit";
    ToPlace: "to (X; Y)", "bis (X; Y)";
    Draws: "The same over vehicles drawn from what the data sheet leaves open",
        "Dasselbe über Fahrzeuge, gezogen aus dem, was das Datenblatt offen lässt";
    VehiclesDrawn: "draws of vehicle and road", "Ziehungen von Fahrzeug und Fahrbahn";
    LeftOut: "could not be computed and are left out", "ließen sich nicht berechnen und fehlen";
    EndX: "X at the end", "X am Ende", "Of the CG, along the road from the impact";
    EndY: "Y at the end", "Y am Ende", "Of the CG, to the left";
    TimeToRest: "time to rest", "Zeit bis zum Stillstand", "From the start of the motion";
    RestX: "X at rest", "X im Stillstand";
    RestY: "Y at rest", "Y im Stillstand";
    TimeToRestOrLimit: "time to rest, or followed", "Zeit bis zum Stillstand oder verfolgt", "Draws that still move count with the time for which they are followed";
    DistanceToRestOrLimit: "distance to rest, or followed", "Auslaufstrecke oder verfolgt", "Draws that still move count with their way until then";
    RestXOrLimit: "X at rest, or followed", "X im Stillstand oder verfolgt", "Draws that still move count with where they are then";
    RestYOrLimit: "Y at rest, or followed", "Y im Stillstand oder verfolgt", "Draws that still move count with where they are then";
    HeadingAtRestOrLimit: "heading at rest, or followed", "Gierwinkel im Stillstand oder verfolgt", "Draws that still move count with their heading then";
    ShareAtRest: "comes to rest in", "kommt zum Stillstand in",
        "After the force, speed and yaw rate have fallen below 0.05 m/s and 0.01 rad/s. Draws that \
         still move count with where they are then";
    RestLimit: "followed for at most", "verfolgt bis höchstens";
    Region50: "area that holds the position with 50 %", "Fläche, in der die Lage mit 50 % liegt";
    Agreement: "Do the methods agree?", "Stimmen die Verfahren überein?";
    MethodsVerdict: "the two methods", "die beiden Verfahren";
    MethodsAgree: "agree: each ends within what the other allows",
        "stimmen überein: jedes endet im Bereich, den das andere zulässt";
    AgreeInRegion: "agree in part: the other ends in the 90 % region, but further away than it is known to err",
        "stimmen teilweise überein: das andere endet in der Fläche von 90 %, aber weiter weg, als es bekanntlich irrt";
    AgreeWithinError: "agree in part: no further apart than the other is known to err, but it ends outside the 90 % region",
        "stimmen teilweise überein: nicht weiter auseinander, als das andere bekanntlich irrt, aber außerhalb der Fläche von 90 %";
    AgreeWithinErrorAlone: "are no further apart than the other is known to err",
        "liegen nicht weiter auseinander, als das andere bekanntlich irrt";
    MethodsDisagree: "do not agree", "stimmen nicht überein";
    OtherMethod: "the other method", "das andere Verfahren";
    RivalSameForce: "the 4DOF model without a network, under the same force",
        "das 4DOF-Modell ohne Netz unter derselben Kraft";
    RivalMomentum: "the 4DOF model without a network, under the impulse of the momentum solution",
        "das 4DOF-Modell ohne Netz unter dem Impuls der Impulslösung";
    ImpulsesAgree: "agree: each lies in the 90 % intervals of the other",
        "stimmen überein: jedes Ergebnis liegt in den 90-%-Intervallen des anderen";
    AgreeInNetwork: "agree in part: the momentum solution lies in the 90 % intervals of the force network, which lies further away than the momentum solution is known to err",
        "stimmen teilweise überein: die Impulslösung liegt in den 90-%-Intervallen des Kraftnetzes, dieses aber weiter weg, als die Impulslösung bekanntlich irrt";
    AgreeInMomentum: "agree in part: no further apart than the momentum solution is known to err, but that lies outside the 90 % intervals of the force network",
        "stimmen teilweise überein: nicht weiter auseinander, als die Impulslösung bekanntlich irrt, aber diese liegt außerhalb der 90-%-Intervalle des Kraftnetzes";
    RivalNetwork: "the force network, of which the momentum solution knows nothing",
        "das Kraftnetz, von dem die Impulslösung nichts weiß";
    MomentumImpulse: "size of the impulse, momentum solution", "Betrag des Impulses, Impulslösung",
        "Its intervals are the errors that it was measured to have on 200 finite-element runs";
    NetworkImpulse: "size of the impulse, force network", "Betrag des Impulses, Kraftnetz";
    MomentumDeltaV: "Δv of the struck vehicle, momentum solution",
        "Δv des gestoßenen Fahrzeugs, Impulslösung", "Impulse over mass";
    NetworkDeltaV: "Δv of the struck vehicle, force network",
        "Δv des gestoßenen Fahrzeugs, Kraftnetz", "Impulse over mass";
    MomentumPdof: "direction of the force, momentum solution", "Richtung der Kraft, Impulslösung",
        "Clockwise from straight ahead of the struck vehicle, where the force comes from";
    NetworkPdof: "direction of the force, force network", "Richtung der Kraft, Kraftnetz",
        "Clockwise from straight ahead of the struck vehicle, where the force comes from";
    NetworkShare: "share of the force network", "Anteil des Kraftnetzes",
        "The rest of its answer is the momentum solution with its measured errors";
    NetworkLearned: "the network has learned how car bodies crush and catch; the momentum solution has one restitution, one friction limit and one contact point",
        "das Netz hat gelernt, wie Karosserien nachgeben und sich verhaken; die Impulslösung hat eine Stoßziffer, einen Reibbeiwert und einen Kontaktpunkt";
    ComparedAfter: "compared after", "verglichen nach";
    ForecastPlace: "mean of the forecast (X; Y)", "Mittel der Vorhersage (X; Y)";
    RivalPlace: "by the other method (X; Y)", "nach dem anderen Verfahren (X; Y)";
    RivalHeading: "change of heading by the other method",
        "Änderung des Gierwinkels nach dem anderen Verfahren";
    Apart: "distance between the two", "Abstand der beiden";
    RivalRegion: "smallest region of the forecast that holds the other",
        "kleinste Fläche der Vorhersage, die das andere enthält";
    RivalError: "the other errs by less in three of four motions",
        "das andere irrt in drei von vier Bewegungen um weniger als";
    WhyApart: "why they differ", "warum sie sich unterscheiden";
    OtherForce: "another force, and what the network corrects of the motion",
        "eine andere Kraft und was das Netz an der Bewegung verbessert";
    NetworkCorrects: "what the network corrects of the motion",
        "was das Netz an der Bewegung verbessert";
    MonteCarlo: "sampling error of the interval ends", "Stichprobenfehler der Intervallgrenzen",
        "Largest standard error of an end of the 90 % intervals of place and heading, as a share of \
         the width, by the number of draws: with another seed they differ by about as much";
    MonteCarloRegion: "sampling error of the 90 % area", "Stichprobenfehler der Fläche von 90 %",
        "Standard error of the area by the number of draws";
    Region90: "area that holds the position with 90 %", "Fläche, in der die Lage mit 90 % liegt";
    // Both vehicles through all contacts.
    StruckCourses: "What becomes of the struck vehicle", "Was aus dem gestoßenen Fahrzeug wird";
    Course: "course of events", "Geschehensablauf";
    Wheel: "wheel", "Rad";
    EvidenceItem: "item", "Merkmal";
    WithoutPart: "without", "ohne";
    PlacesOfSite: "Parts of the ground that the vehicles come to", "Teile des Geländes, auf die die Fahrzeuge gelangen";
    PlaceOfSite: "part of the ground", "Teil des Geländes";
    StruckEnters: "struck comes over it", "gestoßenes gelangt darauf",
        "A part of the vehicle, at any time; a vehicle that is over it at first contact counts";
    StruckEndsThere: "struck ends there", "gestoßenes endet dort", "A part of the vehicle";
    StrikingEnters: "striking comes over it", "stoßendes gelangt darauf",
        "A part of the vehicle, at any time; a vehicle that is over it at first contact counts";
    StrikingEndsThere: "striking ends there", "stoßendes endet dort", "A part of the vehicle";
    CourseMissed: "the vehicles miss each other", "die Fahrzeuge verfehlen sich";
    CourseAcross: "it ends across the front of the striking vehicle",
        "es endet quer vor dem stoßenden Fahrzeug", "Still in contact at the end of the motion";
    CourseHooked: "it ends in contact with the striking vehicle",
        "es endet im Kontakt mit dem stoßenden Fahrzeug", "Still in contact at the end of the motion";
    CourseRecovers: "it comes free and turns by less than 90°",
        "es kommt frei und dreht sich um weniger als 90°";
    CourseTurns: "it comes free and turns by 90° to 180°",
        "es kommt frei und dreht sich um 90° bis 180°";
    CourseSpins: "it comes free and turns by more than 180°",
        "es kommt frei und dreht sich um mehr als 180°";
    Contacts: "Contact of the vehicles, from the first touch to the end",
        "Kontakt der Fahrzeuge, vom ersten Berühren bis zum Ende";
    FirstByLaw: "draws whose first contact follows from the contact law",
        "Ziehungen, deren erster Kontakt aus dem Kontaktgesetz folgt",
        "In the others it is the force that the network predicts, or that was given";
    LongContact: "probability of contact for more than 0.3 s",
        "Wahrscheinlichkeit eines Kontakts von mehr als 0,3 s", "All phases of contact together";
    MeetAgainByImpact: "cars meet again, as the impact alone moves them",
        "erneuter Kontakt der Fahrzeuge, bewegt allein durch den Stoß";
    MeetAgain: "probability that they part and meet again",
        "Wahrscheinlichkeit, dass sie sich trennen und wieder treffen";
    TimeInContact: "time in contact", "Zeit im Kontakt", "All phases of contact together";
    TotalImpulse: "impulse of all contacts", "Impuls aller Kontakte";
    LaterShare: "share of the impulse after the force of the first contact",
        "Anteil des Impulses nach der Kraft des ersten Kontakts";
    LawScale: "scale of the faces' stiffness", "Maßstab der Steifigkeit der Flächen",
        "By which the contact law takes the work that the force of the first contact took";
    PhasesAtMedian: "Phases of contact, medians over the draws in which they occur",
        "Phasen des Kontakts, Mediane über die Ziehungen, in denen sie vorkommen";
    Phases: "Phases of contact", "Phasen des Kontakts";
    Phase: "phase", "Phase";
    PhaseStart: "begins at", "beginnt bei";
    PhaseDuration: "lasts", "dauert";
    PhaseStruckDeltaV: "Δv, struck", "Δv, gestoßenes Fzg.",
        "By the contact force alone, as an event data recorder integrates it";
    PhaseStruckPdof: "PDOF, struck", "PDOF, gestoßenes Fzg.", "Clockwise from the heading";
    PhaseStrikingDeltaV: "Δv, striking", "Δv, stoßendes Fzg.",
        "By the contact force alone, as an event data recorder integrates it";
    PhaseStrikingPdof: "PDOF, striking", "PDOF, stoßendes Fzg.", "Clockwise from the heading";
    ToTheEnd: "to the end", "bis zum Ende";
    NoImpulse: "–", "–";
    Followed: "followed", "verfolgt";
    UntilStruckRests: "until the struck vehicle is at rest",
        "bis das gestoßene Fahrzeug zur Ruhe kommt";
    StrikingForecast: "Predicted motion of the striking vehicle",
        "Vorhergesagte Bewegung des stoßenden Fahrzeugs";
    SecondContact: "probability of a second contact", "Wahrscheinlichkeit eines zweiten Kontakts";
    Sensitivity: "Linear share of each estimate in the variance of the end; shares that may be chance \
        are left out",
        "Linearer Anteil jedes Schätzwerts an der Varianz des Endes; Anteile, die Zufall sein können, \
         fehlen";
    Position: "position", "Lage";
    Heading: "heading", "Gierwinkel";
    // The predicted force.
    Force: "Predicted force on the struck vehicle, axes along its heading",
        "Vorhergesagte Kraft auf das gestoßene Fahrzeug, Achsen längs seiner Fahrtrichtung";
    ImpulseSize: "size of the impulse", "Betrag des Impulses";
    ImpulseX: "impulse along x", "Impuls längs x", "On the struck vehicle, along its heading";
    ImpulseY: "impulse along y", "Impuls längs y", "On the struck vehicle, to its left";
    PeakTime: "time of the peak", "Zeitpunkt der größten Kraft";
    ContactDuration: "duration of the contact", "Dauer des Kontakts",
        "From first touch to last separation";
    Hooking: "probability of hooking", "Wahrscheinlichkeit des Verhakens",
        "That the corner of the striking vehicle stays caught";
    Unknown: "unknown", "unbekannt";
    ImpliedRestitution: "implied restitution", "sich ergebende Stoßziffer";
    ImpliedRatio: "implied impulse ratio P_τ/P_n", "sich ergebendes Impulsverhältnis P_τ/P_n";
    MomentumBeside: "momentum solution beside it", "Impulslösung zum Vergleich";
    NetworkStart: "momentum solution that the network starts from",
        "Impulslösung, von der das Netz ausgeht",
        "With restitution and friction that were fitted to the training cases";
    ContactPoint: "contact point", "Kontaktpunkt";
    StrikingBody: "body of the striking vehicle", "Aufbau des stoßenden Fahrzeugs";
    StruckBody: "body of the struck vehicle", "Aufbau des gestoßenen Fahrzeugs";
    DrawnFromTraining: "open, drawn from that of the training cases",
        "offen, aus dem der Trainingsfälle gezogen";
    ForceModes: "Possible courses of the contact", "Mögliche Verläufe des Kontakts",
        "Components of the mixture, each with its mean curve";
    OtherCourses: "the others together", "die übrigen zusammen";
    Probability: "probability", "Wahrscheinlichkeit";
    Impulse: "impulse", "Impuls";
    // The predicted motion.
    Forecast: "Predicted motion", "Vorhergesagte Bewegung";
    Vehicle: "vehicle", "Fahrzeug";
    MovedBy: "moved by", "bewegt durch";
    GivenForce: "the force as given, in one course", "die Kraft wie angegeben, in einem Verlauf";
    ForcesDrawn: "forces drawn from the force network", "aus dem Kraftnetz gezogene Kräfte";
    PulsesDrawn: "impulses drawn from the momentum solution, with its measured errors",
        "aus der Impulslösung mit ihren gemessenen Fehlern gezogene Impulse";
    StillMovingAfter: "still moving after", "noch in Bewegung nach";
    HeadingChange: "change of heading", "Änderung des Gierwinkels",
        "Since the impact, to the left; goes on beyond a turn";
    SpeedAtEnd: "speed at the end, mean of the draws",
        "Geschwindigkeit am Ende, Mittel der Ziehungen";
    YawRateAtEnd: "yaw rate at the end, mean of the draws",
        "Gierrate am Ende, Mittel der Ziehungen", "Positive to the left";
    QuarterTurn: "probability of a quarter turn or more",
        "Wahrscheinlichkeit einer Vierteldrehung oder mehr";
    HalfTurn: "probability of a half turn or more", "Wahrscheinlichkeit einer halben Drehung oder mehr";
    Applicability: "share of the response network", "Anteil des Bewegungsnetzes",
        "As it falls, the forecast goes over to the 4DOF model, and its bands to the error of that";
    // The reconstruction.
    Speeds: "What the evidence says of the speeds, before the impact unless said otherwise",
        "Was die Spuren über die Geschwindigkeiten sagen, vor dem Aufprall, wenn nicht anders gesagt";
    SpeedAtStart: "What the evidence says of the speed at the start",
        "Was die Spuren über die Geschwindigkeit am Anfang sagen";
    ByHand: "By hand, each number from its own part of the evidence",
        "Von Hand gerechnet, jede Zahl aus einem eigenen Teil der Spuren";
    Hinges: "What the speeds hinge on: by how much they move if one quantity is larger",
        "Wovon die Geschwindigkeiten abhängen: um wie viel sie sich ändern, wenn eine Größe größer ist";
    OneSigma: "± one standard deviation", "± eine Standardabweichung";
    HoldsBy: "from", "aus";
    Motions: "simulated motions", "simulierte Bewegungen";
    Particles: "particles", "Partikel";
    EffectiveSamples: "equivalent independent draws, of all motions",
        "effektiver Stichprobenumfang aller Bewegungen",
        "The particles are taken from all motions by their weights, so that it may exceed their number";
    Courses: "Courses of events that the evidence leaves possible",
        "Geschehensabläufe, die nach den Spuren möglich bleiben";
    IfThis: "If this happened", "Wenn es so war";
    StruckCar: "struck car", "gestoßenes Fzg.", "Its speed before the impact";
    StrikingCar: "striking car", "stoßendes Fzg.", "Its speed before the impact";
    SingleCar: "car", "Fahrzeug", "Its speed at the start";
    Fit: "Items of the evidence: found and expected", "Spuren: vorgefunden und erwartet";
    PathFit: "Tire marks that were found against the computed paths",
        "Gefundene Reifenspuren gegen die berechneten Bahnen",
        "How far a mark lies from the path of its wheel, and where along that it begins and ends";
    ByMark: "computed from the mark", "aus der Spur berechnet",
        "Median over the particles: it depends on the path that is computed";
    Found: "found", "gefunden", "What was found";
    Expected: "expected", "erwartet", "Median over the particles of what would be found";
    TailProbability: "p", "p",
        "Probability that measurement and model err by more than they do here";
    Verdict: "verdict", "Urteil";
    Explained: "explained", "erklärt";
    Unexplained: "not explained", "nicht erklärt";
    MarksCompared: "Tire marks that were found beside those of a particle of median speed",
        "Gefundene Reifenspuren neben denen einer Bewegung mit mittlerer Geschwindigkeit";
    FoundLength: "found length", "gefundene Länge";
    ComputedLength: "computed length", "berechnete Länge";
    MeanDistance: "mean distance", "mittlerer Abstand";
    LargestDistance: "largest distance", "größter Abstand";
    NoMark: "no mark", "keine Spur";
    BudgetAtStart: "Half the width of the 90 % interval of the speed at the start, now and with a \
        further measurement",
        "Halbe Breite des 90-%-Intervalls der Geschwindigkeit am Anfang, jetzt und mit einer weiteren \
         Messung";
    Budget: "Half the width of the 90 % interval of the struck car’s speed, now and with a further \
        measurement",
        "Halbe Breite des 90-%-Intervalls der Geschwindigkeit des gestoßenen Fahrzeugs, jetzt und mit \
         einer weiteren Messung";
    Now: "now, ±", "jetzt, ±";
    Then: "then, ±", "dann, ±";
    LeftOutEvidence: "Without each part of the evidence", "Ohne je einen Teil der Spuren",
        "The same draws, weighted by the likelihood without the part";
    SoFarOff: "chance to lie so far off", "Wahrscheinlichkeit, so weit abzuliegen",
        "An upper bound: with which the others expect the part as far off as it was found, or farther";
    IndependentDraws: "independent draws", "unabhängige Ziehungen";
    GoesWithOthers: "goes with the others", "passt zu den übrigen";
    Contradicted: "contradicts the others", "widerspricht den übrigen";
    NotJudged: "too few draws to say", "zu wenige Ziehungen für eine Aussage";
    NotBelievable: "too few particles to say", "zu wenige Partikel für eine Aussage";
    // Trainings and models.
    ForceTraining: "Training of the force network", "Training des Kraftnetzes";
    ResponseTraining: "Training of the response network", "Training des Bewegungsnetzes";
    CasesLearned: "cases learned from", "Fälle zum Lernen";
    CasesForValidation: "cases for validation", "Fälle zur Validierung", "They decide when to stop";
    CasesForTest: "cases kept for the test", "für den Test zurückgehaltene Fälle";
    TrajectoriesLearned: "trajectories learned from", "Bewegungen zum Lernen";
    TrajectoriesForTest: "trajectories kept for the test", "für den Test zurückgehaltene Bewegungen";
    BestEpoch: "best epoch", "beste Epoche", "Its weights are those of the model";
    Epochs: "epochs", "Epochen";
    ValidationLoss: "validation loss", "Validierungsverlust", "Of the best epoch";
    LastLoss: "last loss", "letzter Verlust", "Of the last epoch";
    Weights: "weights", "Gewichte";
    VarianceFactors: "factors of the calibration", "Faktoren der Kalibrierung",
        "On variances and peaks, from calibration on training cases";
    FarVarianceFactors: "factors far from the cases", "Faktoren fern von den Fällen",
        "From calibration on the training cases that are farthest from the others";
    LatentScales: "uncertainty", "Unsicherheit", "Standard deviations of the latent factors";
    CalibratedOn: "uncertainty calibrated on", "Unsicherheit kalibriert an";
    UsualValues: "nothing: the usual values", "nichts: übliche Werte";
    GuessOfModelBefore: "nothing: a guess, that of the model before and at least the usual",
        "nichts: geschätzt wie beim Modell davor, mindestens wie üblich";
    UnseenTrajectories: "trajectories, each unseen", "Bewegungen, jede zuvor ungesehen";
    TrajectoriesOfModelBefore: "trajectories, by the model before", "Bewegungen, vom Modell davor";
    CarsKnown: "cars that it knows", "bekannte Fahrzeuge";
    Seed: "seed", "Startwert des Zufallsgenerators";
    Program: "program", "Programm";
    Data: "data", "Daten";
    Origin: "how it came to be", "Herkunft";
    Figures: "Figures", "Kennwerte";
    ComputingTime: "computing time", "Rechenzeit";
    Losses: "Losses of the epoch", "Verluste der Epoche";
    LossTerm: "term", "Anteil";
    OfTraining: "training", "Training";
    OfValidation: "validation", "Validierung";
    UnusualSettings: "Settings that are not the usual ones", "Abweichungen von den üblichen Einstellungen";
    MotionFrom: "motion learned from, beginning at", "gelernte Bewegung ab";
    ForceOrigin: "force", "Kraft";
    ForceRecorded: "recorded", "aufgezeichnet";
    ForceEstimated: "estimated from the change of momentum", "aus der Impulsänderung geschätzt";
    States: "states learned from", "gelernte Zustände";
    PositionNoise: "noise of the position", "Rauschen der Lage";
    YawNoise: "noise of the yaw angle", "Rauschen des Gierwinkels";
    VelocityNoise: "noise of the velocity", "Rauschen der Geschwindigkeit";
    YawRateNoise: "noise of the yaw rate", "Rauschen der Gierrate";
    CasesLeftOut: "Cases that are left out, and why", "Ausgelassene Fälle, mit Grund";
    // The simulation of a data set.
    Replay: "Simulation beside the recorded motions", "Simulation neben den aufgezeichneten Bewegungen";
    ReplayedCases: "Each case", "Die einzelnen Fälle";
    ReplaySummary: "Errors over the cases", "Fehler über die Fälle";
    Case: "case", "Fall";
    Cases: "cases", "Fälle";
    KindOfMotion: "motion", "Bewegung";
    Spin: "spin", "Schleudern", "The heading changes by more than 90 deg";
    PathError: "average error", "mittlerer Fehler", "Mean distance from the recorded path";
    EndError: "final error", "Fehler am Ende", "Distance from the recorded end";
    EndHeadingError: "final heading error", "Gierwinkelfehler am Ende";
    Flags: "flags", "Auffälligkeiten";
    OfEachCase: "those of each case", "die der einzelnen Fälle";
    StruckPathError: "struck: average error", "gestoßen: mittlerer Fehler",
        "Mean distance from the recorded path";
    StruckEndError: "struck: final error", "gestoßen: Fehler am Ende";
    StruckHeadingError: "struck: final heading error", "gestoßen: Gierwinkelfehler am Ende";
    StrikingPathError: "striking: average error", "stoßend: mittlerer Fehler";
    StrikingEndError: "striking: final error", "stoßend: Fehler am Ende";
    StrikingHeadingError: "striking: final heading error", "stoßend: Gierwinkelfehler am Ende";
    ContactTime: "in contact", "in Kontakt";
    ContactTimeRecorded: "in contact, recorded", "in Kontakt, aufgezeichnet";
    ContactImpulse: "impulse of the contacts", "Impuls der Kontakte";
    ContactImpulseRecorded: "impulse, recorded", "Impuls, aufgezeichnet";
    ContactOfPairs: "Contact of the pairs: medians over the cases",
        "Kontakt der Paare: Mediane über die Fälle";
    ContactTimeRatio: "duration, simulated over recorded", "Dauer, simuliert zu aufgezeichnet";
    ContactTimeError: "error of the duration", "Fehler der Dauer";
    ContactImpulseRatio: "impulse, simulated over recorded", "Impuls, simuliert zu aufgezeichnet";
    ContactImpulseError: "error of the impulse", "Fehler des Impulses";
    AllCases: "all", "alle";
    Spinning: "spinning", "mit Schleudern";
    NotSpinning: "not spinning", "ohne Schleudern";
    ErrorKind: "error", "Fehler";
    Number: "n", "Anzahl";
    Mean: "mean", "Mittel";
    StandardDeviation: "std", "Std.-Abw.", "Standard deviation";
    Percentile90: "p90", "90-%-Quantil", "Nine of ten are smaller";
    Largest: "max", "größter Wert";
    // Evaluations.
    StagedCollisions: "Reconstructions beside the truth", "Rekonstruktionen neben der Wahrheit";
    Stopped: "stopped", "abgebrochen";
    StoppedEarly: "before all cases were done", "bevor alle Fälle fertig waren";
    TruthsInIntervals: "truths within the intervals, and errors of the medians",
        "wahre Werte in den Intervallen, und Fehler der Mediane";
    HeldIntervals: "How often such intervals held", "Wie oft solche Intervalle zutrafen",
        "Cases with a known truth: the shares whose intervals held it";
    In50: "in 50 %", "in 50 %", "Share of the cases whose interval of 50 % held the true value";
    In90: "in 90 %", "in 90 %", "Share of the cases whose interval of 90 % held the true value";
    ConfidenceFrom: "at least", "mindestens", "Lower bound of 95 % confidence of that share, after Wilson";
    ConfidenceTo: "at most", "höchstens", "Upper bound of 95 % confidence of that share, after Wilson";
    RecordedPairs: "Forecasts beside recorded pairs", "Vorhersagen neben aufgezeichneten Paaren";
    PairDraws: "draws of each case", "Ziehungen je Fall";
    MeanPathError: "mean error", "mittlerer Fehler",
        "Mean over the cases of the mean distance of the positions over 4 s from the first contact";
    MedianPathError: "median error", "Median des Fehlers";
    MedianEndError: "at the end", "am Ende",
        "Median over the cases of the distance of the positions at the end of the record";
    QuarterTurnRight: "turn of 90° right", "Drehung um 90° richtig",
        "Share of the cases in which the likelier side of a turn of 90° was the recorded one";
    HalfTurnRight: "turn of 180° right", "Drehung um 180° richtig", "The same of a turn of 180°";
    PathIn50: "path in 50 %", "Bahn in 50 %",
        "Share of the instants at which the region of 50 % held the recorded position";
    PathIn90: "path in 90 %", "Bahn in 90 %", "The same of the region of 90 %";
    EndIn50: "end in 50 %", "Ende in 50 %",
        "Share of the cases in which the region of 50 % held the position at the end of the record";
    EndIn90: "end in 90 %", "Ende in 90 %", "The same of the region of 90 %";
    StabilityTwins: "Stability control: the same collisions with and without it",
        "Fahrdynamikregelung (ESC): dieselben Kollisionen mit und ohne sie";
    RecordedTurnWithout: "turn without, recorded", "Drehung ohne, aufgezeichnet",
        "Largest turn of the struck vehicle without stability control";
    ForecastTurnWithout: "turn without, median", "Drehung ohne, Median";
    QuarterTurnChanceWithout: "turns by 90° or more without", "dreht sich ohne sie um 90° oder mehr",
        "Probability that the largest turn of the struck vehicle is so large";
    RecordedTurnWith: "turn with, recorded", "Drehung mit, aufgezeichnet",
        "Largest turn of the struck vehicle with stability control";
    ForecastTurnWith: "turn with, median", "Drehung mit, Median";
    QuarterTurnChanceWith: "turns by 90° or more with", "dreht sich mit ihr um 90° oder mehr",
        "Probability that the largest turn of the struck vehicle is so large";
    SavedRecorded: "effect, recorded", "Wirkung, aufgezeichnet",
        "Saved: the vehicle turns by 90° or more without stability control alone";
    SavedForecast: "effect, forecast", "Wirkung, vorhergesagt";
    Saved: "saved", "gerettet";
    NotSaved: "not saved", "nicht gerettet";
    EffectOfStabilityControl: "Effect of stability control", "Wirkung der Fahrdynamikregelung (ESC)";
    EffectRight: "effect forecast as recorded", "Wirkung wie aufgezeichnet vorhergesagt";
    SavedAndForecast: "saved, and forecast to be", "gerettet und so vorhergesagt";
    SavedNotForecast: "saved, but not forecast to be", "gerettet, aber nicht so vorhergesagt";
    ForecastNotSaved: "forecast to be saved, but not", "als gerettet vorhergesagt, aber nicht";
    NeitherSavedNorForecast: "neither saved nor forecast to be", "weder gerettet noch so vorhergesagt";
    TurnsWithoutRecorded: "turns by 90° or more without it, recorded",
        "dreht sich ohne sie um 90° oder mehr, aufgezeichnet";
    TurnsWithoutForecast: "turns by 90° or more without it, forecast",
        "dreht sich ohne sie um 90° oder mehr, vorhergesagt";
    TurnsWithRecorded: "turns by 90° or more with it, recorded",
        "dreht sich mit ihr um 90° oder mehr, aufgezeichnet";
    TurnsWithForecast: "turns by 90° or more with it, forecast",
        "dreht sich mit ihr um 90° oder mehr, vorhergesagt";
    CaseTimes: "Time of a case", "Rechenzeit eines Falls";
    KnownEvidence: "known", "bekannt", "How much of the evidence was used";
    Method: "method", "Verfahren";
    SufficientEss: "ESS 400 or more", "ESS von mindestens 400", "Effective sample size";
    Level50: "50 %", "50 %";
    Level80: "80 %", "80 %";
    Level90: "90 %", "90 %";
    Level95: "95 %", "95 %";
    MedianSizeOfError: "|error|, median", "|Fehler|, Median";
    MedianError: "error, median", "Fehler, Median";
    MedianWidth: "width of 90 %, median", "Breite von 90 %, Median";
    MeanCrps: "CRPS, mean", "CRPS, Mittel", "Continuous ranked probability score";
    ForceEvaluation: "Force network beside its baselines", "Kraftnetz neben Vergleichsverfahren";
    CrossValidation: "Force networks, each on the cases that it has not seen",
        "Kraftnetze, jedes mit den Fällen, die es nicht kennt";
    CasesOfTraining: "of them learned from", "davon gelernt";
    CasesOfBaselines: "cases that the baselines are fitted to",
        "Fälle, an die die Vergleichsverfahren angepasst sind";
    Folds: "folds", "Teilmengen";
    NameOfModel: "model", "Modell";
    ErrorsOfAll: "Errors over all cases", "Fehler über alle Fälle";
    ErrorsOfSeparated: "Errors without cases that hook or have not separated",
        "Fehler ohne Fälle, die sich verhaken oder nicht trennen";
    Statistic: "over the cases", "über die Fälle";
    HistoryError: "history", "Verlauf", "‖F̂ − F‖ / ‖F‖, both axes";
    RmseOverPeak: "RMSE/peak", "RMSE/Spitze", "Root mean square error over the peak of |F|";
    ImpulseError: "impulse vector", "Impulsvektor", "|P̂ − P| / |P|";
    PeakError: "peak", "Spitze", "Error of the largest |F| over the largest |F|";
    DurationError: "contact time", "Kontaktdauer", "Error of the duration over the duration";
    Coverage: "Share inside the bands, ± standard error between cases",
        "Anteil in den Bändern, ± Standardfehler zwischen den Fällen";
    BandOf: "bands of", "Bänder";
    ForceCurve: "F(t)", "F(t)";
    InDomain: "in the domain", "im Gültigkeitsbereich";
    OutsideDomain: "outside", "außerhalb";
    Scores: "Mean scores, smaller is better", "Mittlere Bewertungen, kleiner ist besser";
    CrpsForce: "CRPS F(t)", "CRPS F(t)";
    EnergyScore: "energy score", "Energy Score";
    CrpsImpulse: "CRPS |P|", "CRPS |P|";
    CrpsPeak: "CRPS peak", "CRPS Spitze";
    CrpsDuration: "CRPS duration", "CRPS Dauer";
    LogLikelihood: "NLL [nats]", "NLL [nat]", "Negative log-likelihood";
    ErrorsByCluster: "Errors by cluster of impulse", "Fehler nach Impulsklasse";
    Cluster: "cluster", "Klasse",
        "k-means of the training cases by impulse and force, ordered by impulse";
    ClusterCentre: "centre", "Mitte", "Impulse at the centre of the cluster";
    HistoryOfGaussianProcesses: "history, Gaussian processes", "Verlauf, Gauß-Prozesse",
        "Error of the strongest baseline";
    ResponseEvaluation: "Response models on recorded trajectories",
        "Bewegungsmodelle an aufgezeichneten Bewegungen";
    UnseenMotions: "trajectories", "Bewegungen";
    Choices: "choices of those to learn from", "Auswahlen der Bewegungen zum Lernen";
    // Methods by hand.
    HandResults: "By hand", "Von Hand";
    HandAtValues: "at the values of the inputs, ± to first order",
        "bei den Werten der Eingaben, ± in erster Ordnung", "± is one standard deviation";
    HandAvoided: "stops before the place of the collision with", "steht vor der Unfallstelle mit";
    HandInputs: "Inputs of the calculation by hand", "Eingaben der Rechnung von Hand";
    HandSource: "stated or assumed", "angegeben oder angenommen";
    HandSigmaAssumed: "value stated, ± assumed", "Wert angegeben, ± angenommen";
    HandSensitivities: "What one standard deviation more of an input, or 1 % of an exact one, changes",
        "Was eine Standardabweichung mehr einer Eingabe oder 1 % einer genauen ändert";
    HandBias: "The same formula on marks of the 4DOF model, whose speed is known",
        "Dieselbe Formel auf Spuren des 4DOF-Modells, deren Geschwindigkeit bekannt ist";
    HandBiasTruth: "true speed at the start of the mark", "wahre Geschwindigkeit am Beginn der Spur";
    HandBiasSteer: "angle of the front wheels", "Winkel der Vorderräder";
    HandBiasRadius: "radius at its beginning", "Radius an ihrem Beginn";
    HandBiasSpeed: "speed by the mark", "Geschwindigkeit nach der Spur";
    HandBiasRatio: "of the true speed", "der wahren Geschwindigkeit";
    HandBiasMean: "mean, and from smallest to largest", "Mittel, und vom kleinsten zum größten";
    HandFormula: "How the method works", "Wie das Verfahren rechnet";
    HandEquation: "equation", "Gleichung";
    HandHolds: "holds if", "gilt, wenn";
    // The replay of a recorder.
    RecorderAtContact: "The car at the first contact", "Das Fahrzeug beim ersten Kontakt";
    RecorderSpeed: "speed at the first contact", "Geschwindigkeit beim ersten Kontakt";
    RecorderSideslip: "sideslip at the first contact", "Schwimmwinkel beim ersten Kontakt",
        "From the heading to the velocity of the CG, positive to the left";
    RecorderYawRateAtContact: "yaw rate at the first contact", "Gierrate beim ersten Kontakt";
    RecorderWay: "From the first sample to the first contact",
        "Vom ersten Abtastwert bis zum ersten Kontakt";
    RecorderAhead: "way ahead", "Weg nach vorn", "In the axes of the car at the first sample";
    RecorderLeft: "way to the left", "Weg nach links", "In the axes of the car at the first sample";
    RecorderTurn: "turn to the left", "Drehung nach links";
    RecorderLength: "way along the path", "Weg entlang der Bahn";
    RecorderFrictionUse: "share of the friction that is used at most", "höchste Nutzung der Reibung";
    RecorderStart: "Where it was at the first sample", "Wo es beim ersten Abtastwert war";
    RecorderStartX: "X of the first sample", "X des ersten Abtastwerts";
    RecorderStartY: "Y of the first sample", "Y des ersten Abtastwerts";
    RecorderStartHeading: "heading of the first sample", "Gierwinkel beim ersten Abtastwert";
    RecorderSamples: "Recorded samples beside the computed motion",
        "Aufgezeichnete Werte neben der berechneten Bewegung";
    RecorderTime: "time on the recorder's clock", "Zeit auf der Uhr des Datenspeichers";
    RecorderRecordedSpeed: "speed, recorded", "Geschwindigkeit, aufgezeichnet";
    RecorderRecordedYawRate: "yaw rate, recorded", "Gierrate, aufgezeichnet";
    RecorderComputedYawRate: "yaw rate, computed", "Gierrate, berechnet";
    RecorderYawCheck: "Recorded yaw rate against the computed one",
        "Aufgezeichnete Gierrate gegen die berechnete";
    RecorderYawDifference: "difference (root mean square)", "Unterschied (quadratisches Mittel)";
    RecorderYawDeviations: "difference in standard deviations", "Unterschied in Standardabweichungen";
    RecorderYawFactor: "recorded over computed", "aufgezeichnet durch berechnet",
        "Over the samples before the tires come near their limit";
    RecorderYawRatio: "steering ratio with which they would be alike",
        "Lenkübersetzung, mit der beide gleich wären",
        "Over the samples before the tires come near their limit, if nothing else is wrong";
    // The check of files.
    Checked: "What was checked", "Geprüft";
    DataSets: "data sets", "Datensätze";
    Files: "files", "Dateien";
    Problems: "problems", "Probleme";
    Problem: "problem", "Problem";
    CasesWithFlags: "cases with flags", "auffällige Fälle";
    NotGiven: "not given", "nicht angegeben";
    Columns: "columns", "Spalten";
    Samples: "samples", "Messwerte";
    TimeSpan: "time", "Zeit";
    Format: "format", "Format";
    Note: "note", "Hinweis";
    Name: "name", "Name";
    Contents: "contents", "Inhalt";
    Command: "command", "Befehl";
    ColumnsRead: "Columns that are read", "Gelesene Spalten";
    ColumnsFound: "Columns that are found", "Gefundene Spalten";
    Column: "column", "Spalte";
    Channel: "channel", "Kanal";
    Unit: "unit", "Einheit";
    UnitIs: "which is", "sie ist";
    Stated: "stated", "angegeben";
    Assumed: "assumed", "angenommen";
    FirstValues: "first values", "erste Werte";
    ProposedMap: "for a force file, complete", "für eine Kraftdatei ergänzen";
    FlagsFound: "Flags, the worst first", "Auffälligkeiten, die schwersten zuerst";
    Severity: "severity", "Schwere";
    Flag: "flag", "Auffälligkeit";
    Meaning: "meaning", "Bedeutung";
    Clean: "clean", "unauffällig";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_has_a_name_in_each_language_and_no_two_rows_share_one() {
        let labels = |language| Term::ALL.iter().map(move |term| term.label(language));
        assert!(labels(Language::De).all(|label| !label.is_empty()));
        let mut english: Vec<&str> = labels(Language::En).collect();
        english.sort_unstable();
        let n = english.len();
        english.dedup();
        assert_eq!(english.len(), n);
    }

    /// One car was “der Wagen” in the tables of a recorder, and “das Fahrzeug” elsewhere; draws were also “Züge”.
    #[test]
    fn one_thing_has_one_german_word() {
        for label in Term::ALL.iter().map(|term| term.label(Language::De)) {
            assert!(!label.contains("Wagen") && !label.contains("Züge"), "{label}");
        }
    }

    /// “90° or more without” headed a column, and nothing in it turned.
    #[test]
    fn an_angle_says_what_turns_by_it() {
        for language in [Language::En, Language::De] {
            // It goes on where the one of 90° ends.
            let terms = Term::ALL.iter().filter(|term| **term != Term::TurnedHalf);
            let labels = terms.map(|term| term.label(language));
            for label in labels.filter(|label| label.contains("90°") || label.contains("180°")) {
                let is_told = ["turn", "dreht", "Drehung"].iter().any(|word| label.contains(word));
                assert!(is_told, "{label}");
            }
        }
    }
}
