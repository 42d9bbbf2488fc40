//! The German words around the citations of a report: where vehicle data come from, and what a source is cited
//! for. Titles, authors and journals stay as they were published.

/// Notes of vehicle data, and what sources are cited for, with the German ones.
pub(super) const TERMS: &[(&str, &str)] = &[
    // Sources of the vehicles that come with the program.
    ("class only: all values by rule", "nur die Klasse ist bekannt: alle Werte nach Regel"),
    ("nothing else is published", "mehr ist nicht veröffentlicht"),
    ("tracks", "Spurweiten"),
    ("CG", "Schwerpunkt"),
    ("kerb weight", "Leergewicht"),
    // Rules of the vehicles of the data sets.
    ("as the reference car", "wie beim Referenzfahrzeug"),
    ("as the finite-element target", "wie beim gestoßenen Fahrzeug der Finite-Elemente-Rechnungen"),
    ("a mid-size car", "ein Mittelklassewagen"),
    (
        "the finite-element body is a front or rear part only",
        "das Finite-Elemente-Modell ist nur ein Vorder- oder Hinterwagen",
    ),
    (
        "I_xx/m of the reference car times (width ratio)², + m_s h²",
        "I_xx/m des Referenzfahrzeugs × (Breitenverhältnis)², + m_s h²",
    ),
    (
        "I_xz/m of the reference car times length ratio and CG-height ratio",
        "I_xz/m des Referenzfahrzeugs × Längenverhältnis × Verhältnis der Schwerpunkthöhen",
    ),
    (
        "I_zz/m of the reference car times (length ratio)²",
        "I_zz/m des Referenzfahrzeugs × (Längenverhältnis)²",
    ),
    (
        "air drag neglected at model speeds",
        "Luftwiderstand bei Modellgeschwindigkeiten vernachlässigt",
    ),
    ("l_f + overhang, times the length ratio", "l_f + Überhang, × Längenverhältnis"),
    (
        "the reference car's, times the CG-height ratio",
        "der Wert des Referenzfahrzeugs × Verhältnis der Schwerpunkthöhen",
    ),
    (
        "the reference car's, times the length ratio",
        "der Wert des Referenzfahrzeugs × Längenverhältnis",
    ),
    (
        "0.0115 × mass × radius² (13 multibody cars)",
        "0.0115 × Masse × Halbmesser² (13 Mehrkörpermodelle)",
    ),
    // When a speed by hand holds.
    (
        "distance to rest; all wheels were locked from the start on",
        "Weg bis zum Stillstand; alle Räder waren von Anfang an blockiert",
    ),
    (
        "distance to rest; all wheels were locked from the impact on",
        "Weg bis zum Stillstand; alle Räder waren vom Stoß an blockiert",
    ),
    (
        "distance to rest; the brakes locked all wheels at once",
        "Weg bis zum Stillstand; die Bremsen blockierten sofort alle Räder",
    ),
    (
        "distance to rest; it spun with wheels that turned, with half of the friction",
        "Weg bis zum Stillstand; es schleuderte mit drehenden Rädern, mit dem halben Reibbeiwert",
    ),
    (
        "momentum of both cars before and after; the struck car drove straight on, the striking car \
         along its heading",
        "Impuls beider Fahrzeuge davor und danach; das gestoßene fuhr geradeaus, das stoßende in \
         Richtung seiner Längsachse",
    ),
    (
        "momentum in line; the speed of the struck car is the one that is stated",
        "Impuls auf einer Linie; die Geschwindigkeit des gestoßenen Fahrzeugs ist die angegebene",
    ),
    // Where a case lies outside of the atlas.
    ("Mass of the struck car", "Masse des gestoßenen Fahrzeugs"),
    ("Mass of the striking car", "Masse des stoßenden Fahrzeugs"),
    ("Speed above that of the struck car", "Geschwindigkeit über der des gestoßenen Fahrzeugs"),
    (
        "Heading of the striking car beyond its way",
        "Winkel von der Bewegungsrichtung zur Längsachse des stoßenden Fahrzeugs",
    ),
    // How a publication is described.
    ("2nd ed.", "2. Aufl."),
    ("dissertation", "Dissertation"),
    ("program manuals of the HVE environment", "Programmhandbücher der HVE-Umgebung"),
    ("model year 2004", "Modelljahr 2004"),
    // What sources are cited for.
    (
        "Impact with compression to a common velocity and restitution as a share of the impulse of \
         compression; sliding on a contact plane.",
        "Stoß mit Kompression bis zur gemeinsamen Geschwindigkeit und Restitution als Anteil des \
         Kompressionsimpulses; Gleiten auf einer Kontaktebene.",
    ),
    (
        "Together with Kudlich1966 the impact model of common reconstruction programs.",
        "Zusammen mit Kudlich1966 das Stoßmodell der üblichen Rekonstruktionsprogramme.",
    ),
    (
        "Planar impact mechanics, restitution and impulse ratio.",
        "Ebene Stoßmechanik, Stoßziffer und Impulsverhältnis.",
    ),
    (
        "Restitution from the point of common velocity, friction limit, worked barrier example.",
        "Restitution ab der gemeinsamen Geschwindigkeit, Reibungsgrenze, durchgerechnetes \
         Beispiel eines Barrierenaufpralls.",
    ),
    (
        "Braking performance and the distribution of braking forces: chapter 3.",
        "Bremsvermögen und Bremskraftverteilung: Kapitel 3.",
    ),
    (
        "Force of two outlines from their crush, share of the crush that is given back, printed \
         example, stiffness of printed cars.",
        "Kraft zweier Umrisse aus ihrer Stauchung, Anteil der Rückfederung, gedrucktes Beispiel, \
         Steifigkeiten der gedruckten Fahrzeuge.",
    ),
    (
        "Crush that is linear in the speed of a barrier test; the force per width A + B δ.",
        "Stauchung linear in der Geschwindigkeit eines Barrierenversuchs; Kraft je Breite A + B δ.",
    ),
    (
        "Field studies of the critical speed: biases within 10 % to 15 % on the average, towards speeds that are too low.",
        "Feldstudien zur Kurvengrenzgeschwindigkeit: im Mittel höchstens um 10 bis 15 % verzerrt, hin zu kleineren \
         Geschwindigkeiten.",
    ),
    (
        "Δv from crush against 121 event data recorders: 23 % too low on the average without restitution, 1 % with it in \
         frontal crashes.",
        "Δv aus der Stauchung gegen 121 Unfalldatenspeicher: im Mittel 23 % zu klein ohne Restitution, 1 % mit ihr bei \
         Frontalstößen.",
    ),
    (
        "Limits of the critical speed and what comes of its misuse.",
        "Grenzen der Kurvengrenzgeschwindigkeit und Folgen ihres Missbrauchs.",
    ),
    (
        "Regression, marginal likelihood and its gradient.",
        "Regression, marginale Likelihood und ihr Gradient.",
    ),
    (
        "Particles along a sequence of distributions.",
        "Partikel entlang einer Folge von Verteilungen.",
    ),
    (
        "The next temperature from the effective sample size.",
        "Die nächste Temperatur aus dem effektiven Stichprobenumfang.",
    ),
    (
        "Mixtures with a defensive component, which bounds the weights.",
        "Mischungen mit einer Komponente, die die Gewichte begrenzt.",
    ),
    (
        "All draws weighted as those of one mixture of all distributions that were drawn from.",
        "Alle Ziehungen gewichtet wie die einer Mischung aller Verteilungen, aus denen gezogen \
         wurde.",
    ),
    (
        "Discrepancy between model and reality as a Gaussian process.",
        "Abweichung zwischen Modell und Wirklichkeit als Gauß-Prozess.",
    ),
    (
        "Measured masses, CG heights and moments of inertia of light vehicles. Its numbers are used \
         as KktseInertia2020 evaluates them.",
        "Gemessene Massen, Schwerpunkthöhen und Trägheitsmomente leichter Fahrzeuge. Die Zahlen \
         sind in der Auswertung von KktseInertia2020 verwendet.",
    ),
    (
        "Medians, quartiles and extremes of dynamic indices and stability factors over the \
         unballasted vehicles of Heydinger1999.",
        "Mediane, Quartile und Extremwerte der bezogenen Trägheiten und der Stabilitätsfaktoren \
         über die unbeladenen Fahrzeuge von Heydinger1999.",
    ),
    (
        "Tracks, wheelbases, weights and CG of vehicles on scales and tilt table, with the weight of \
         a driver; as collected in the public repository kktse/stunning-octo-doodle-ncap.",
        "Spurweiten, Radstände, Gewichte und Schwerpunkte auf Waagen und Kipptisch, mit dem Gewicht \
         eines Fahrers; nach der öffentlichen Sammlung kktse/stunning-octo-doodle-ncap.",
    ),
    (
        "outer dimensions, wheelbases and tracks of vehicles sold in Canada, as served by the vPIC \
         interface of the NHTSA and collected, rounded to 1 cm, in the public repository \
         shifter907/allcarsdb (data/body_configs.csv).",
        "Außenmaße, Radstände und Spurweiten in Kanada verkaufter Fahrzeuge, nach der vPIC-Schnittstelle \
         der NHTSA und der auf 1 cm gerundeten öffentlichen Sammlung shifter907/allcarsdb \
         (data/body_configs.csv).",
    ),
];

/// The same with numbers, names or lists in them, for which `{}` stands in both languages.
pub(super) const TEMPLATES: &[(&str, &str)] = &[
    // Sources of the vehicles that come with the program.
    (
        "NHTSA NCAP {} rollover measurements, with a driver's weight ({})",
        "NHTSA NCAP {}, Kippversuche, mit dem Gewicht eines Fahrers ({})",
    ),
    ("Transport Canada CVS ({})", "Transport Canada CVS ({})"),
    ("comma.ai opendbc ({})", "comma.ai opendbc ({})"),
    ("EPA OMEGA ({})", "EPA OMEGA ({})"),
    ("Wikipedia ({})", "Wikipedia ({})"),
    (
        "{}. Of the police car with its equipment no mass is published here: enter it as it was weighed",
        "{}. Für das Polizeifahrzeug mit seiner Ausrüstung ist hier keine Masse veröffentlicht: die \
         gewogene ist einzugeben",
    ),
    (
        "Bullet of the finite-element runs (body A), datasets/README.md: mass, I_zz = {} · mass, half width {}",
        "stoßendes Fahrzeug der Finite-Elemente-Rechnungen (Aufbau A), datasets/README.md: Masse, \
         I_zz = {} · Masse, halbe Breite {}",
    ),
    (
        "Target of the finite-element runs, datasets/README.md: mass, I_zz = {} · mass, rear axle, half width {}",
        "gestoßenes Fahrzeug der Finite-Elemente-Rechnungen, datasets/README.md: Masse, I_zz = {} · \
         Masse, Hinterachse, halbe Breite {}",
    ),
    (
        "Y. Jiang, J. Wang, D. Li, tables of the scaled vehicles: mass {}, {}",
        "Y. Jiang, J. Wang, D. Li, Tabellen der Modellfahrzeuge: Masse {}, {}",
    ),
    // Where a case lies outside of the atlas.
    ("{}: {}, the map has {} to {}", "{}: {}, der Atlas reicht von {} bis {}"),
    // Rules of the vehicles of the data sets.
    ("{} of the outer height, as the reference car", "{} der Außenhöhe, wie beim Referenzfahrzeug"),
    (
        "{} of the outer width, as the reference car",
        "{} der Außenbreite, wie beim Referenzfahrzeug",
    ),
    ("air drag of {} at the vehicle's weight", "Luftwiderstand von {} bei diesem Gewicht"),
    (
        "l_f + {} front overhang, scaled with the length",
        "l_f + {} Überhang vorn, im Maßstab der Länge",
    ),
    (
        "rear axle at {} as in the finite-element model, weight {} as the reference car",
        "Hinterachse bei {} wie im Finite-Elemente-Modell, Achslasten {} wie beim Referenzfahrzeug",
    ),
    (
        "the reference car's damping ratio in roll, {}",
        "Dämpfungsgrad des Wankens des Referenzfahrzeugs, {}",
    ),
    (
        "the reference car's roll gradient, {}: m_s g h (1/gradient + 1)",
        "Wankgradient des Referenzfahrzeugs, {}: m_s g h (1/Gradient + 1)",
    ),
    ("in the scale of the length, 1:{}", "im Maßstab der Länge, 1:{}"),
    ("the reference car's share of the mass, {}", "Massenanteil des Referenzfahrzeugs, {}"),
];
