//! The texts of a report in German.

use crate::report::language::words::Words;

/// Texts of the report itself.
pub(super) const WORDS: Words = Words {
    report: "Bericht",
    to: "bis",
    yes: "ja",
    no: "nein",
    none: "keine",
    values: "Werte",
    page_of: "Seite {page} von {n}",
    figure: "Bild",
    intro: "Fall „{case}“, {date}. Berechnet mit impactlab {version}. Jede Antwort in diesem Bericht \
        wurde aus dem Fall und den Dateien berechnet, die er nennt.",
    units_si: "Einheiten: {units}. Winkel und Gierraten sind nach links positiv.",
    units_us: "Einheiten: {units}; Wanksteifigkeit und -dämpfung, Rollwiderstand, Luftwiderstandsflächen und die \
        Fehler in Abschnitt 7 in SI-Einheiten. Winkel und Gierraten sind nach links positiv.",
    language_note: "Titel von Veröffentlichungen stehen in Anführungszeichen, wie sie erschienen sind; ebenso Namen \
        aus dem Fall und Fehlermeldungen, die das Programm nur auf Englisch ausgibt.",
    notes: "Bemerkungen des Bearbeiters",
    changed_notice: "Seit dem Speichern des Falls hat sich etwas geändert: {what}. Die Antworten gelten für \
        den jetzigen Stand und können von den damaligen abweichen.",
    change_missing: "die Datei {path} fehlt",
    change_changed: "die Datei {path} wurde geändert",
    change_case: "die Falldatei {path} selbst wurde ohne das Programm bearbeitet",
    change_model: "das {network} „{name}“ ist ein anderes",
    unanswered_notice: "Unbeantwortete Fragen: {n} von {all}; die Gründe stehen unten.",
    no_answer: "Keine Antwort: {error}",
    no_answer_of: "{name}: keine Antwort: {error}",
    variant: "Variante: {name}",
    variant_column: "Variante",
    all_variants: "alle Varianten",
    alike: "In jeder dieser Varianten: {values}.",
    beside_intervals: "{caption} (in Klammern das 90-%-Intervall)",
    variants_beside: "Die Varianten stehen nebeneinander. 50-%-Intervalle stehen in den Antworten von \
        „impactlab case run --json“.",
    not_answered_for: "Nicht gefragt oder ohne Antwort: {names}.",
    inputs_same_as: "Wie in Variante „{name}“, außer dem, was die Tabelle nennt.",
    inputs_all_same: "Wie in Variante „{name}“.",
    inputs_without: "Nicht in dieser Variante: {list}.",
    annex: "Anhang",
    section_opinion: "Gutachten",
    section_answers: "Fragen und Antworten",
    section_pictures: "Lagebilder und Verläufe",
    section_inputs: "Eingangsgrößen",
    section_evidence: "Spuren und Anpassung",
    section_method: "Verfahren",
    section_validity: "Gültigkeit und Einschränkungen",
    section_validation: "Validierung der Modelle",
    at_validation: "Abschnitt 7",
    section_sensitivity: "Empfindlichkeit",
    section_provenance: "Versionen, Startwerte, Dateien",
    section_log: "Protokoll des Falls",
    quantity: "Größe",
    value: "Wert",
    part_of: "Teil",
    class: "Art",
    source: "Herkunft und Unsicherheit",
    class_given: "vorgegeben",
    class_measured: "gemessen",
    class_estimated: "nach Regel",
    class_assumed: "angenommen",
    no_intervals: "Diese Werte haben kein Intervall: sie folgen aus den Werten in Abschnitt 3, so wie sie \
        dort stehen, und enthalten deren Unsicherheit nicht.",
    title_impact: "Stoß",
    title_simulate: "Auslaufbewegung nach dem 4DOF-Modell",
    title_force: "Vorhergesagte Stoßkraft",
    title_motion: "Vorhergesagte Auslaufbewegung",
    title_reconstruct: "Rekonstruktion",
    ask_impact: "Frage: Welchen Impuls, welche Geschwindigkeitsänderungen und welche Gierraten bewirkt \
        der Zusammenstoß „{name}“ nach der ebenen Stoßmechanik?",
    ask_simulate: "Frage: Wie bewegt sich das gestoßene Fahrzeug ({vehicle}) nach dem Aufprall „{name}“, \
        nach dem 4DOF-Fahrzeugmodell?",
    ask_drive: "Frage: Wie bewegt sich das Fahrzeug ({vehicle}) in „{name}“ nach dem 4DOF-Fahrzeugmodell?",
    ask_force: "Frage: Welche Stoßkraft bewirkt der Zusammenstoß „{name}“ nach dem Kraftnetz, und wie \
        sicher ist das?",
    ask_motion: "Frage: Wohin bewegt sich das gestoßene Fahrzeug ({vehicle}) nach dem Aufprall „{name}“ \
        nach dem Bewegungsnetz, und wie sicher ist das?",
    of_other_mass: "{vehicle}, hier mit {mass}",
    ask_reconstruct: "Frage: Wie schnell waren beide Fahrzeuge vor dem Zusammenstoß „{name}“, nach den \
        vorgefundenen Spuren?",
    ask_single_car: "Frage: Wie schnell war das Fahrzeug im Fall „{name}“ am Anfang der Bewegung, nach den \
        vorgefundenen Spuren?",
    ask_other: "Frage: {kind}.",
    other_caption: "Alles, was die Antwort enthält",
    struck_vehicle: "gestoßenes Fahrzeug",
    striking_vehicle: "stoßendes Fahrzeug",
    impact_picture: "Der Stoß von oben: Impuls und Geschwindigkeitsänderungen beim ersten Kontakt",
    friction_zones: "Bereiche mit eigenem Reibbeiwert",
    zone_value: "Reibbeiwert {friction}; Ecken (X; Y) {corners}",
    meaning_draws: "In jeder Zeile liegen neun von zehn gezogenen Fahrzeugen im Bereich von 90 %; variiert wird nur, was \
        das Datenblatt offen lässt.",
    scene_picture: "Simulation von oben, Fahrzeuge am Ende",
    contact_picture: "Simulation in Perspektive, Fahrzeuge am Ende des Kontakts",
    ground_not_drawn: "; das Gelände ist nicht gezeichnet: {why}",
    force_picture: "Stoßkraft auf das gestoßene Fahrzeug über der Zeit, {axes}",
    yaw_rate_picture: "Gierrate des gestoßenen Fahrzeugs über der Zeit",
    yaw_rate_alone_picture: "Gierrate des Fahrzeugs über der Zeit",
    controls_picture: "{quantity} über der Zeit",
    vehicles_drawn: "gezogene Fahrzeuge:",
    forces_drawn: "Kräfte:",
    meaning_force: "Jeder Wert liegt mit dieser Wahrscheinlichkeit in seinem Bereich von 90 %, nach der Verteilung des \
        Kraftnetzes. Wie oft solche Bereiche zutrafen, steht in Abschnitt 7, soweit es geprüft wurde.",
    force_network: "Kraftnetz",
    response_network: "Bewegungsnetz",
    applicability: "Der Fall liegt teilweise außerhalb dessen, woran das {network} gelernt hat: {share} der \
        Verteilung stammen vom Netz, der Rest allein aus der Physik.",
    applies: "Das {network} zählt voll: Kein Teil der Verteilung stammt allein aus der Physik.",
    force_forecast_picture: "Vorhergesagte Kraft auf das gestoßene Fahrzeug: Betrag über der Zeit mit Bändern",
    meaning_motion: "Jeder Wert liegt mit dieser Wahrscheinlichkeit in seinem Bereich von 90 %, nach der Verteilung des \
        Bewegungsnetzes über die gezogenen Kräfte und Fahrzeuge. Wie oft solche Bereiche des Ortes zutrafen, \
        steht in Abschnitt 7.",
    meaning_motion_one: "Jeder Wert liegt mit dieser Wahrscheinlichkeit in seinem Bereich von 90 %, nach der Verteilung des \
        Bewegungsnetzes für diese eine Kraft und dieses Fahrzeug, deren eigene Unsicherheit fehlt. Wie oft \
        solche Bereiche des Ortes zutrafen, steht in Abschnitt 7.",
    phases_text: "Eine Phase des Kontakts dauert von der Berührung bis zur Trennung, auch während ein Fahrzeug das andere \
        weiterschiebt; ihr Impuls und ihr Δv, nach der Kontaktkraft allein, gelten für die ganze Phase und nicht für die \
        Kraft des ersten Kontakts, die eigens angegeben ist.",
    learned_duration: "Das Bewegungsnetz hat aus Bewegungen von bis zu {time} gelernt; danach rechnet die \
        Vorhersage mit dem 4DOF-Modell und den angepassten Effekten weiter.",
    forecast_scene_picture: "Vorhersage von oben: Bahnen, Dichte und Bereiche von 50 und 90 % am Ende",
    forecast_paths_picture: "Vorhersage von oben: Bahnen; keine Dichte, da sich die Fahrzeuge vor dem Ende erneut \
        berühren",
    atlas_heading: "Der Fall im Atlas des PIT-Manövers",
    atlas_text: "Der Atlas ist eine Modellstudie: {all} berechnete Manöver, an keinem gemessenen PIT geprüft. Er \
                 sagt, wie oft etwas unter diesen vorkommt; er belegt nicht, was hier geschehen ist, und nennt keine \
                 Geschwindigkeit sicher. Die Tabelle gilt für {rows} von {all}, die in denselben Zellen liegen wie der \
                 Fall: {like}. Gemittelt ist über: {averaged}. In {inside} davon gelten beide Netze. In allen lenkt der \
                 Fahrer des stoßenden Fahrzeugs weiter ein, hält das Tempo und bremst, sobald sich das gestoßene \
                 gedreht hat.",
    atlas_outside: "Der Fall liegt außerhalb des Atlas, der nichts über ihn sagt: {list}.",
    atlas_picture: "Der Fall im Atlas des PIT-Manövers, einer Modellstudie: Wahrscheinlichkeit einer Drehung um 90° oder \
                    mehr. Waagerecht: {x}; senkrecht: {y}; festgehalten: {held}",
    atlas_table: "Ausgang der berechneten Manöver in den Zellen des Falls",
    atlas_other_networks: "Der Atlas wurde mit anderen Netzen berechnet als denen, die hier geantwortet haben ({list}): \
                           Er und die Vorhersage können sich allein deshalb unterscheiden.",
    atlas_rest: "alles, was keine Achse des Atlas ist",
    atlas_nothing: "nichts",
    atlas_error: "Standardfehler",
    atlas_few: "zu wenige",
    atlas_doubtful: "nicht verlässlich",
    after_second_contact: "Die Fahrzeuge berühren sich vor dem Ende erneut, und dieser Kontakt wird nicht berechnet: \
        wohin sie danach kommen, hat keine Wahrscheinlichkeit, und die Mediane sind die einer Bewegung ohne ihn.",
    forecast_yaw_picture: "Vorhersage: Gierwinkel des gestoßenen Fahrzeugs über der Zeit mit Bändern",
    ask_hand: "Frage: Was ergibt „{name}“, von Hand gerechnet?",
    ask_replay: "Frage: Wie bewegte sich das Fahrzeug {vehicle} bis zum ersten Kontakt, nach Geschwindigkeit und \
        Lenkwinkel seines Unfalldatenspeichers ({name})?",
    meaning_replay: "Jeder Wert liegt mit dieser Wahrscheinlichkeit in seinem Bereich von 90 %, wenn die Aufzeichnung \
        die dieser Bewegung ist und ihre Fehler so sind, wie sie gezogen wurden; wie oft solche Bereiche \
        zutreffen, hat niemand gemessen.",
    draws_replay: "Ziehungen der Aufzeichnung:",
    replay_path_picture: "Bahn bis zum ersten Kontakt von oben, mit dem Band von 90 % der Ziehungen quer zu ihr",
    replay_picture: "{quantity} über der Uhr des Datenspeichers: aufgezeichnet und nachgerechnet, mit dem Band von \
                     90 %",
    meaning_hand: "Jeder Wert liegt mit dieser Wahrscheinlichkeit in seinem Bereich von 90 %, wenn das Verfahren gilt und die \
                   Eingaben so unsicher sind wie angegeben und nicht stärker voneinander abhängen, als die Hinweise sagen.",
    meaning_posterior: "Jeder Wert liegt mit dieser Wahrscheinlichkeit in seinem Bereich von 90 %, nach den vorgefundenen Spuren, \
        wenn die Annahmen in Abschnitt 3 und die Verfahren in Abschnitt 5 zutreffen.",
    meaning_doubtful: "Auf diese Intervalle{courses} ist kein Verlass: siehe die Warnungen in Abschnitt 6 ({badges}).",
    doubtful_figures: "Auf diese Werte{courses} ist kein Verlass: siehe die Warnungen in Abschnitt 6 ({badges}).",
    doubtful_courses: " und auf die Wahrscheinlichkeiten der Geschehensabläufe",
    too_few_particles: "Es wird kein Intervall angegeben: Der effektive Stichprobenumfang ist zu klein, oder die \
        Rechnung wurde beendet, bevor alle Spuren zählten; die Grenzen eines Intervalls wären die \
        einzelner Partikel. Mit mehr Partikeln erneut fragen und die Rechnung zu Ende führen.",
    held_when_tried: "; bei der Erprobung{known} trafen solche Bereiche in {share} von {n} Fällen zu",
    with_everything_known: " mit allen Anknüpfungstatsachen",
    too_narrow: "Diese Bereiche von 90 % sind als zu schmal anzusehen, da sie bei der Erprobung zu selten zutrafen \
        (Abschnitt 7): {list}.",
    too_narrow_item: "{name}, in {share} von {n} Fällen{known}",
    particles: "Partikel:",
    simulated_motions: "simulierte Bewegungen:",
    ess: "effektiver Stichprobenumfang aller Bewegungen, aus denen die Partikel gezogen sind:",
    log_evidence: "logarithmierte Evidenz:",
    reconstruction_cars: "Rekonstruktion von oben: eine Bewegung mit mittlerer Geschwindigkeit und ihren Reifenspuren, \
        das gestoßene Fahrzeug an deren Ende, über den vorgefundenen Spuren",
    single_car: "Rekonstruktion von oben: eine Bewegung mit mittlerer Geschwindigkeit und ihren Reifenspuren, das \
        Fahrzeug an deren Ende, über den vorgefundenen Spuren",
    reconstruction_picture: "Rekonstruktion von oben: mögliche Bahnen über den vorgefundenen Spuren",
    marginal_picture: "{quantity}: wie wahrscheinlich sie ohne die Spuren ist und mit ihnen",
    fit_text: "p ist die Wahrscheinlichkeit, dass Messung und Modell stärker abweichen als hier; unter \
        {level} gilt eine Spur als nicht erklärt.",
    left_out_text: "Die Geschwindigkeit, wenn jeweils ein Teil der Spuren weggelassen wird. Die Wahrscheinlichkeit, so \
        weit abzuliegen, ist die, mit der die übrigen Teile ihn so weit entfernt erwarten, wie er vorgefunden wurde, \
        oder weiter, gleich nach welcher Seite; angegeben ist eine obere Schranke: die kleinste seiner Merkmale mal \
        deren Anzahl. „≤ 1“ besagt nichts: kein Merkmal des Teils ist auffällig, was nicht beweist, dass der Teil \
        richtig ist. Ein Teil, der das Ergebnis zu sich hinzieht, erscheint durch eben dieses Ergebnis erklärt; hier ist \
        er deshalb selbst ausgenommen.",
    several_courses: "Mehr als ein Geschehensablauf ist möglich. Jeder hat eigene Werte in Abschnitt 4; die unten \
        stehenden über alle können für keinen davon zutreffen.",
    hinges_text: "Eine Ausgleichsgerade durch die Partikel sagt, um wie viel sich eine Geschwindigkeit im Mittel \
        ändert, wenn eine Größe um so viel größer ist, unter Berücksichtigung der Spuren; ± ist der \
        Standardfehler der Geraden. Der Reibbeiwert der Fahrbahn steht immer dort, andere Größen, wo die \
        Gerade mehr als Zufall ist.",
    modes_text: "± ist der Standardfehler aus der Zahl der Partikel. Geschehensabläufe unter 1 % fehlen.",
    no_evidence: "Keine Frage dieses Falls beruht auf vorgefundenen Spuren: es gibt nichts anzupassen.",
    mark_value: "{n} Punkte von {first} bis {last}, je ± {sigma}",
    marks_computed_text: "Ein Rad zeichnet, wo es blockiert ist oder um mehr als {slip} seitlich rutscht, bei mehr \
        als {speed}. Es sind \
        die Spuren des Fahrzeugs selbst, nicht die der aus dem Datenblatt gezogenen Fahrzeuge.",
    marks_compared_text: "Jede gefundene Spur steht neben der nächsten, die ihr Rad in einer Bewegung hinterlässt, der eines \
        Partikels mittlerer Geschwindigkeit; die Abstände sind die der Stellen auf der gefundenen Spur zur gerechneten.",
    prior: "Vorabverteilungen, ohne die Anknüpfungstatsachen",
    uniform: "zwischen {low} und {high}, jeder Wert gleich wahrscheinlich",
    normal_cut: "normal, {value}, abgeschnitten bei {low} und {high}",
    log_normal_cut: "lognormal, Median {median}, σ des Logarithmus {sigma}, abgeschnitten bei {low} \
        und {high}",
    source_prior_given: "Vorabverteilung; mit den Anknüpfungstatsachen oder durch das Fahrzeug vorgegeben",
    source_prior_measured: "Vorabverteilung; gemessen, nach den Anknüpfungstatsachen",
    source_prior_rule: "Vorabverteilung; Regel des Datenblatts mit ihrer Streuung",
    source_prior_drag: "Vorabverteilung; Regel aus der Verzögerung blockierter Räder, die selbst verglichen wird",
    source_prior: "Vorabverteilung; Vorgabewert des Programms",
    source_evidence_sigma: "Anknüpfungstatsachen",
    source_default_sigma: "Anknüpfungstatsachen; ± vom Programm, da dort nicht genannt",
    source_program: "Vorgabe des Programms",
    decision_prior: "mit einer Wahrscheinlichkeit von {share}",
    decision_by_number: "jedes der beiden Räder am Schaden mit einer Wahrscheinlichkeit von {share}, sonst keines",
    source_evidence: "Anknüpfungstatsachen",
    source_question: "Frage",
    source_question_sigma: "Frage; ± vom Programm, da dort nicht genannt",
    source_file: "Datei, siehe Abschnitt 9",
    follows_from_sheet: "Datenblatt, oder folgt aus den Schätzwerten unten",
    inputs_text: "„Vorgegeben“ ist, was die Frage oder die Anknüpfungstatsachen ohne Standardabweichung nennen, auch \
        Einstellungen der Rechnung; „gemessen“ hat eine Standardabweichung (±) oder ist die \
        Grenze einer Aufzeichnung; „nach Regel“ folgt aus anderen Werten nach einer \
        Regel mit bekannter Streuung; „angenommen“ hat das Programm, was niemand angegeben hat.",
    inputs_caption: "{name}: {group}",
    inputs_said: "{caption}; wie in der Frage angegeben",
    inputs_assumed: "vom Programm angenommen",
    inputs_not_used: "vorgegeben und von einer Antwort nicht verwendet",
    inputs_left: "Bei den Vorgaben des Programms belassen: {values}.",
    validity_text: "Was die Modelle des Gutachtens vernachlässigen, steht dort. Es folgt jede Einschränkung, \
        die das Programm gefunden hat, mit Begründung und Abhilfe.",
    validity_by_hand: "Die Voraussetzung jeder Rechnung von Hand steht in Abschnitt 1. Es folgt jede Einschränkung, die das \
        Programm gefunden hat, mit Begründung und Abhilfe.",
    validity_models: "Die übrigen Modelle vernachlässigen:",
    badges_caption: "Einschränkungen der Antworten",
    restriction: "Einschränkung",
    sentence: "Aussage",
    remedy: "Abhilfe",
    holds_for: "Betrifft",
    no_badges: "Das Programm hat nichts gefunden, was die Antworten einschränkt.",
    warning: "Warnung",
    note: "Hinweis",
    allowed_range: "{quantity}: {value}, ohne Einschränkung {range}",
    at_least: "mindestens {low}",
    at_most: "höchstens {high}",
    remedy_outdated: "Neu rechnen.",
    remedy_outside_domain: "Einen Wert im Bereich wählen, sich auf die Physik daneben stützen oder ein Netz mit \
        solchen Kollisionen trainieren.",
    remedy_implausible_contact: "Kontaktpunkt, Seite und Geschwindigkeiten prüfen; die Impulslösung verwenden.",
    remedy_disagreement: "Beide Antworten als möglich ansehen; suchen, was zwischen ihnen entscheidet.",
    remedy_other_vehicle: "Begründen, warum das Fahrzeug der Kollision vom genannten abweicht (Insassen, \
                           Ladung), oder der Kollision die Werte dieses Fahrzeugs geben.",
    remedy_overlap: "Die Fahrzeuge auseinanderrücken, bis die Umrisse sich berühren, oder den Kontaktpunkt \
        angeben.",
    remedy_second_contact: "Die Bewegung nur bis zum zweiten Kontakt verwenden.",
    remedy_contact_not_ended: "Eine Aufzeichnung verwenden, die bis zum Ende der Kraft reicht.",
    remedy_doubtful_data: "Die Datei an der genannten Stelle ansehen oder eine andere Aufzeichnung nehmen.",
    remedy_energy_gain: "Die Fahrzeugparameter prüfen; die Bewegung danach nicht verwenden.",
    remedy_wheel_lift: "Die Bewegung danach als Näherung ansehen: abgehobene Räder übertragen keine Kraft.",
    remedy_roll_limit: "Die Bewegung danach nicht verwenden: ein Überschlag wird nicht simuliert.",
    remedy_not_at_rest: "Bis zum Stillstand oder mit längerer Dauer fragen.",
    remedy_evidence_unexplained: "Diese Spur und ihre Standardabweichung prüfen; einen anderen Geschehensablauf erwägen.",
    remedy_few_particles: "Mit mehr Partikeln erneut fragen.",
    remedy_few_draws: "Mit mehr Ziehungen erneut fragen.",
    remedy_several_courses: "Die Werte jedes Geschehensablaufs für sich verwenden; Spuren suchen, die zwischen ihnen entscheiden.",
    remedy_driver_open: "Angeben, ob der Fahrer bremst, lenkt oder rollen lässt, oder die Antwort für jeden dieser Fälle zeigen.",
    remedy_hardly_validated: "Das Intervall nur mit diesem Vorbehalt angeben.",
    remedy_no_interval: "Die Standardabweichung jeder Eingabe angeben.",
    remedy_left_out: "Die fehlenden Fälle oder Ziehungen ansehen.",
    remedy_trained_on: "Das Netz an Fällen beurteilen, die es nicht kennt.",
    remedy_assumed: "Den Wert angeben, wenn er bekannt ist.",
    remedy_not_used: "Wo es darauf ankommt, mit einem Verfahren rechnen, das dies verwendet.",
    sources: "Quellen",
    number: "Nr.",
    source_title: "Quelle",
    axes_text: "Achsen nach ISO 8855: x nach vorn, y nach links, Gierwinkel nach links positiv. \
        Weltachsen sind die der Lageskizze; bei einer Rekonstruktion beginnen sie im Schwerpunkt \
        des gestoßenen Fahrzeugs beim ersten Kontakt, X längs seiner Fahrtrichtung. \
        Hauptstoßrichtungen zählen in Grad im Uhrzeigersinn von geradeaus, dorthin, woher die \
        Kraft kommt. Intervalle lassen unten so viel weg wie oben.",
    axes_single_car_text: "Achsen nach ISO 8855: x nach vorn, y nach links, Gierwinkel nach links positiv. Weltachsen \
        der Rekonstruktion eines einzelnen Fahrzeugs sind die, in denen die Spuren vermessen wurden. Intervalle \
        lassen unten so viel weg wie oben.",
    axes_driven_text: "Achsen nach ISO 8855: x nach vorn, y nach links, Gierwinkel nach links positiv. Weltachsen sind \
        die der Lageskizze.",
    method_impact: "Ebener Stoß",
    method_impact_text: "Beide Fahrzeuge sind starre Körper in der Ebene, die an einem Kontaktpunkt in unendlich \
        kurzer Zeit einen Impuls austauschen. Impuls und Drall bleiben erhalten; die \
        Normalkomponente folgt aus der Stoßziffer, auf die Normalkomponente bezogen oder von der \
        gemeinsamen Geschwindigkeit aus, die Tangentialkomponente aus der Bedingung, dass die \
        Kontaktpunkte nicht gleiten, begrenzt durch den Reibbeiwert. Der Energieverlust ist die \
        Differenz der kinetischen Energien.",
    limits_impact: "Der Stoß ist unendlich kurz, an einem Punkt und ohne Moment; Reifenkräfte während des \
        Kontakts werden vernachlässigt. Stoßziffer und Reibbeiwert sind Eingangsgrößen.",
    method_four_dof: "4DOF-Fahrzeugmodell",
    method_four_dof_text: "Das gestoßene Fahrzeug bewegt sich längs, quer, im Gieren und im Wanken auf ebener \
        Fahrbahn. Die Seitenkraft jedes Reifens sättigt mit dem Schräglaufwinkel und fällt \
        darüber auf die Gleitreibung; die Radlasten verlagern sich mit den Beschleunigungen; \
        Räder rollen frei, drehen gegen eine Bremse oder sind blockiert. Der Aufprall wirkt als \
        Kraft über der Zeit am Kontaktpunkt. Integriert wird nach Runge–Kutta mit fester \
        Schrittweite, die für Fahrzeuge mit schnelleren Eigenformen geteilt wird.",
    limits_four_dof: "Nicken, Hub, Reifeneinlauf, Rückstellmomente und Achskinematik fehlen; die Fahrbahn ist \
        eben; ein Rad hat den Reibbeiwert der Fahrbahn oder der Zone unter ihm. Ein abhebendes Rad oder ein \
        Wankwinkel über 15° wird gemeldet; ein Überschlag wird nicht simuliert. Wird ein Fahrzeug allein \
        verfolgt, wird ein zweiter Kontakt gemeldet und nicht berechnet.",
    method_four_dof_alone: "4DOF-Fahrzeugmodell eines einzelnen Fahrzeugs",
    method_four_dof_alone_text: "Das Fahrzeug bewegt sich längs, quer, im Gieren und im Wanken. Die Seitenkraft jedes \
        Reifens sättigt mit dem Schräglaufwinkel und fällt darüber auf die Gleitreibung; die Radlasten verlagern sich \
        mit den Beschleunigungen; Räder rollen frei, drehen gegen eine Bremse oder sind blockiert. Integriert wird \
        nach Runge–Kutta mit fester Schrittweite, die für Fahrzeuge mit schnelleren Eigenformen geteilt wird.",
    limits_four_dof_alone: "Nicken, Hub, Reifeneinlauf, Rückstellmomente und Achskinematik fehlen; die Fahrbahn hat \
        überall dieselbe Neigung; ein Rad hat den Reibbeiwert der Fahrbahn oder der Zone, in der es steht. Ein Überschlag wird \
        nicht simuliert.",
    method_contact: "Kontakt zweier Umrisse",
    method_contact_text: "Beide Fahrzeuge werden gemeinsam verfolgt. Ihre Umrisse, Rechtecke mit gerundeten Ecken, sind in \
        Elemente von {element} geteilt; wo sie sich überdecken, werden die Elemente beider in Reihe zusammengedrückt. Die Last \
        eines Elements wächst linear über einen elastischen Ast bis A und dann um B mal die Eindringung, entlastet auf einer \
        steileren Geraden und lässt eine Delle zurück; längs der Fläche wirkt Reibung. A und B folgen nach Regel aus Klasse \
        und Masse, mit einer Streuung von 25 bis 40 %. Wo die Kraft des ersten Kontakts bekannt oder vorhergesagt ist, werden \
        die Lasten so skaliert, dass das Gesetz dieselbe Arbeit aufnimmt, und an ihrem Ende übernimmt das Gesetz. Fahrzeuge \
        in Kontakt werden nach dem Leapfrog-Verfahren integriert, getrennte nach Runge–Kutta. Jede Ziehung hat eigene Steifigkeiten, Reibung, Rückfederung, Reifen, Fahrer und Systeme.",
    limits_contact: "Je Fläche eine Kontaktstelle zur selben Zeit, in einer Höhe. Räder, die sich verhaken, Aufbauten, die \
        aufeinander steigen, und Teile, die abreißen, fehlen. Nahe der Grenze zwischen Freikommen und Schleudern entscheiden \
        kleine Ursachen.",
    method_force: "Kraftnetz",
    method_force_text: "Zwei starre Fahrzeuge, deren Außenhaut nachgibt, bis harte Strukturen dahinter \
        aufeinandertreffen, ergeben eine Kraft über der Zeit; ihre Gesetze sind an die \
        Trainingsfälle angepasst und werden mit Regressionen über dieselben Fälle gemittelt. Ein \
        neuronales Netz um diesen Mittelwert sagt die Verteilung des ganzen Verlaufs als \
        Mischung voraus, einmal an Trainingsfällen kalibriert. Außerhalb des Gelernten tritt die \
        Impulslösung mit ihren gemessenen Fehlern an seine Stelle.",
    limits_force: "Das mitgelieferte hat aus 349 simulierten Stößen gegen die Flanke einer von zwei Limousinen, zu einem Fünftel eines SUV, \
        gelernt, mit Annäherung bis {fast}; das absolute Kraftniveau kann um etwa 40 % falsch sein. Welche \
        dieser Karosserien getroffen wurde, ist ohne Angabe offen. Fahrzeuggröße, Stoßziffer und \
        Reibung zwischen ihnen kennt es nicht.",
    method_response: "Bewegungsnetz",
    method_response_text: "Jeder Schritt der Bewegung ist einer des 4DOF-Modells mit einer begrenzten zusätzlichen \
        Beschleunigung: Effekte bekannter Form mit gelernten Stärken und ein Rest aus einem \
        neuronalen Netz. Ganze Bewegungen werden verfolgt, reihum mit den gezogenen Kräften und \
        Fahrzeugen, mindestens 240, wo ein Fahrzeug für sich allein verfolgt wird; was das Netz \
        offenlässt, wird für jede gezogen. Außerhalb des Gelernten tritt das 4DOF-Modell mit seinen gemessenen Fehlern an seine Stelle.",
    limits_response: "Das mitgelieferte hat aus simulierten Bewegungen von 88 Fahrzeugen von bis zu 12 s gelernt. Die \
        Auslaufstrecke wurde mit keiner Aufzeichnung verglichen.",
    method_reconstruction: "Rekonstruktion aus Spuren",
    method_reconstruction_text: "Alles Unbekannte (Geschwindigkeiten, Winkel, Kontakt, Reibung, Massen, Bremsung, …) hat \
        eine vorab angenommene Verteilung. Für jeden gezogenen Satz von Werten werden Stoß und \
        Auslaufbewegung bis zum Stillstand berechnet und danach gewichtet, wie gut sie zu den \
        Spuren passen, mit der Standardabweichung jeder Messung und einem Modellfehler, der \
        längs der Bahn wächst. Ein sequentielles Monte-Carlo-Verfahren zieht aus der \
        Vorabverteilung, dann aus Mischungen von Normalverteilungen, die den Spuren schrittweise \
        folgen, und gewichtet jede Ziehung nach der Dichte, aus der sie stammt; der Standardfehler der \
        Wahrscheinlichkeiten folgt aus den Gewichten, die Anpassung jeder Spur aus realisierten \
        Abweichungen.",
    limits_reconstruction: "Stoß nach der Impulslösung mit Stoßziffer und Reibung, Bewegung nach dem 4DOF-Modell; \
        die Netze sind nicht beteiligt. Geschwindigkeit und Richtung des stoßenden Fahrzeugs \
        beruhen großenteils auf Annahmen. Eine Bewegung wird 40 s lang verfolgt.",
    method_single_car: "Rekonstruktion eines einzelnen Fahrzeugs",
    method_single_car_text: "Alles Unbekannte (Geschwindigkeit, Schwimmwinkel und Gierrate am Anfang, Reibung, Bremsung, \
        Lenkung, …) hat eine vorab angenommene Verteilung. Für jeden gezogenen Satz von Werten wird die Bewegung vom \
        Anfang bis zum Stillstand berechnet und danach gewichtet, wie gut sie zu den Spuren passt, mit der \
        Standardabweichung jeder Messung und einem Modellfehler, der längs der Bahn wächst. Ein sequentielles \
        Monte-Carlo-Verfahren zieht aus der Vorabverteilung, dann aus Mischungen von Normalverteilungen, die den \
        Spuren schrittweise folgen, und gewichtet jede Ziehung nach der Dichte, aus der sie stammt.",
    limits_single_car: "Bewegung nach dem 4DOF-Modell mit Vorderrädern, die mit einem Winkel gehalten werden; die \
        Netze sind nicht beteiligt. Ein Fahrer, der hin und her lenkt oder die Bremse löst, bleibt außer \
        Betracht. Ein Antiblockiersystem hält den Schlupf nahe der größten Reibung und hinterlässt keine Spuren. Eine \
        Bewegung wird 40 s lang verfolgt.",
    validation_single_car: "Fahrzeuge, die dieses Programm mit seinen eigenen Bewegungsgleichungen berechnet hat. Kein \
        reales wurde geprüft.",
    method_sheet: "Fahrzeugdaten nach Regel",
    method_sheet_text: "Was ein Datenblatt nicht nennt, folgt aus dem Übrigen nach Regeln mit einer Streuung, \
        jede mit ihrer Quelle in Abschnitt 3. Wo Fahrzeuge gezogen werden, wird jede offene \
        Größe aus ihrer Streuung gezogen.",
    limits_sheet: "Trägheit, Schwerpunkthöhe und Achslasten beruhen auf gemessenen Fahrzeugen von 1971 bis \
        2005; Fahrwerk und Reifen auf 13 Mehrkörpermodellen, die plausibel, aber nicht gemessen \
        sind.",
    validation_text: "Diese Zahlen stammen nicht aus diesem Fall: sie sagen, wie gut die Modelle waren, wo die \
        Wahrheit bekannt war. Die Daten sind Simulationen, keine Messungen; kein realer Unfall \
        wurde geprüft. Quelle: docs/VALIDATION.md des Programms, mit dem Befehl zu jeder \
        Tabelle.",
    other_networks: "Geantwortet haben andere Netze als die voreingestellten: {list}. Grenzen des Verfahrens und \
        Validierung in diesem Bericht sind die der voreingestellten, die mit dem Programm kommen: woraus sie gelernt \
        haben und wie gut sie waren. Über diese Netze sagen sie nichts: `impactlab evaluate` misst sie.",
    validation_impact: "Gegen Finite-Elemente-Rechnungen von Stößen gegen eine Flanke mit Annäherung von {slow} bis \
        {middle}. Nicht geprüft wurden höhere Annäherungsgeschwindigkeiten, bei denen die Stoßziffer kleiner ist, Stöße \
        gegen Front oder Heck, Wände und Pfähle.",
    table_impact: "Fehler des Impulsvektors, Median (Mittel), %",
    validation_four_dof: "Gegen ein Mehrkörpermodell desselben Fahrzeugs, an dem seine Parameter gemessen wurden, über \
        4 s. Bei fünfzehn Fahrzeugen, von denen nur das Datenblatt bekannt war, war der Fehler größer: über die ersten \
        4 s im Mittel 1,13 m, im Median 0,68 m, bei 180 Bewegungen.",
    table_four_dof: "Abstand zur Referenzbahn",
    validation_force: "Das mitgelieferte, gegen 25 Finite-Elemente-Rechnungen, die es nicht kennt, mit Annäherung von \
        {slow} bis {middle}; Intervalle von 50 % sind dort zu breit. Von 61 anderen, mit Annäherung bis {fast}, enthielten Intervalle von 90 % \
        89 % der Impulse, 87 % der größten Kräfte und 95 % der Dauern; der Fehler des Impulses war dort im Mittel 18 %, \
        im Median 13 %.",
    table_force: "Fehler, Median (Mittel), %",
    table_force_coverage: "Anteil der wahren Werte in den Intervallen, %, ± Standardfehler",
    validation_response: "Das mitgelieferte, gegen 371 simulierte Bewegungen von 31 Fahrzeugen, die das Netz nicht kennt, jeweils \
        nach Datenblatt: Fehler über 4 s und am Ende, bis 12 s; Anteile der Zeitpunkte und Enden in den Bereichen. \
        Keine reale Bewegung wurde geprüft.",
    validation_contact: "95 simulierte Paare von Mehrkörperfahrzeugen, 84 davon PIT-Manöver; an die Hälfte ist das Gesetz \
        angepasst. Dort galt es von der ersten Berührung an, ohne Kraftnetz, und das Verhalten der Fahrer war bekannt. Bei drei \
        Fahrzeugen, die im rechten Winkel, und vier, die von hinten getroffen wurden, waren die Flächen entlang des Weges \
        zu klein. Geprüft wurden keine Wand, kein Pfahl und kein realer Unfall.",
    table_contact: "Fehler über 4 s und am Ende, m, richtige Drehungen und Anteile der Zeitpunkte und Enden in den Flächen",
    table_response: "Fehler, m, und Abdeckung",
    validation_reconstruction: "40 simulierte Stöße gegen das Heckviertel eines Mehrkörperfahrzeugs mit drei Massen; \
        20 davon wurden beim Einstellen des Verfahrens betrachtet \
        („Einstellung“). Kein realer Unfall wurde geprüft.",
    measured_on: "gemessen am",
    table_reconstruction: "Anteil der wahren Werte in den Intervallen, % (Grenzen von 95 % Sicherheit), und Fehler; alles bekannt. Andere Rechnungen: Fälle beider Hälften, deren Finite-Elemente-Rechnung nicht zu denen gehört, an die die Annahme über Stoßziffer und Reibung angepasst ist",
    table_without_recorder: "Dasselbe ohne den Unfalldatenspeicher",
    table_rest_alone: "Dasselbe allein mit Endlagen, Schaden, Massen und Reibbeiwert",
    validation_sheet: "Die Regeln tragen die Streuung der Fahrzeuge, aus denen sie stammen; sie steht bei jedem \
        Schätzwert.",
    no_methods: "Keine Antwort stammt aus einem Modell.",
    method_by_hand: "Die Gleichung jeder Rechnung von Hand, ihre Voraussetzung und ihre Quellen stehen in Abschnitt 1. \
        Intervalle lassen unten so viel weg wie oben.",
    validation_by_hand: "Die Tests des Programms vergleichen die Gleichungen mit Aufgaben, deren Lösungen veröffentlicht sind. \
        Wie oft die Bereiche solcher Rechnungen zutrafen, wurde nicht gezählt.",
    no_sensitivity: "Keine Antwort dieses Falls enthält ein Maß dafür, wovon sie abhängt: es wird nichts \
        gezogen, oder nichts Gezogenes bewegt das Ergebnis stärker als der Zufall.",
    provenance_caption: "Antworten",
    answer: "Antwort",
    version: "Version",
    seeds: "Startwerte und Ziehungen",
    no_draws: "nichts gezogen",
    files_caption: "Dateien des Falls, jetziger Stand",
    file: "Datei",
    bytes: "Bytes",
    sha256: "SHA-256",
    no_files: "Der Fall verwendet keine Dateien.",
    state: "Stand",
    unchanged: "wie gespeichert",
    new_file: "bisher nicht erfasst",
    missing: "fehlt",
    changed: "geändert",
    models_caption: "Trainierte Netze, die geantwortet haben",
    network: "Netz",
    name: "Name",
    no_models: "Kein trainiertes Netz hat geantwortet.",
    reproduce_text: "Dieselbe Version ergibt mit denselben Dateien, Startwerten und Einstellungen dieselben \
        Zahlen auf der gleichen Art von Prozessor; ein anderer kann letzte Stellen anders runden, \
        was Ziehungen verschiebt. Ein Bericht desselben Falls mit demselben Datum hat dieselben Bytes.",
    case_saved_by: "Der Fall wurde mit Version {version} gespeichert; dieser Bericht stammt von Version \
        {now}.",
    case_file: "Falldatei {path}: {bytes} Bytes, SHA-256 {sha256}; {state}.",
    case_as_saved: "ihr Inhalt ist der, den das Programm gespeichert hat",
    case_edited: "sie wurde bearbeitet, seit das Programm sie gespeichert hat",
    case_without_seal: "sie trägt kein Siegel des Programms: von Hand oder mit einer früheren Version geschrieben",
    case_in_no_file: "Der Fall selbst wurde nicht als Datei gespeichert.",
    log_caption: "Was wann geschah, UTC",
    time: "Zeit",
    event: "Vorgang",
    no_log: "Der Fall hat kein Protokoll.",
    no_pictures: "Keine Antwort hat ein Bild.",
    not_drawn: "Dieses Programm zeichnet keine Bilder: {caption}",
    scene_alt: "{title}. Fahrzeuge auf dem Boden. Dargestellt: {names}.",
    axes_alt: "{title}. Waagerechte Achse: {x}. Senkrechte Achse: {y}. Dargestellt: {names}.",
    car_alt: "Bei {time} {name}: X {x}, Y {y}, Gierwinkel {heading}.",
    line_alt: "{name}: von {y0} bei {x0} bis {y1} bei {x1}; kleinster Wert {low} bei {at_low}, größter {high} bei {at_high}.",
    place_alt: "{name}: von ({x0}; {y0}) bis ({x1}; {y1}).",
    band_alt: "{name}: {low} bis {high} bei {x}.",
    instant_alt: "{name}: bei {x}.",
    picture_elsewhere: "Das Bild steht im PDF dieses Berichts.",
    noted: "Hinweis: {note}.",
    seed: "Startwert",
    domain_caption: "Gültigkeitsbereich der Netze",
    signature: "Ort, Datum, Unterschrift: ______________________________",
};
