//! The texts of the opinion in each language.

use crate::report::Language;

/// Texts of the opinion, in one language. Names in braces are filled in.
pub(super) struct OpinionWords {
    pub question_and_answer: &'static str,
    pub of_variant: &'static str,
    pub nothing_to_say: &'static str,
    pub courses: &'static str,
    pub course: &'static str,
    pub probability: &'static str,
    pub figures: &'static str,
    pub figures_in_doubt: &'static str,
    pub figures_alone: &'static str,
    pub figures_of_simulation: &'static str,
    pub figures_of_impact: &'static str,
    pub differs: &'static str,
    pub first_variant: &'static str,
    pub asked_alike: &'static str,
    pub without: &'static str,
    pub more: &'static str,
    pub notes: &'static str,
    pub in_no_draw: &'static str,
    pub how_sure: &'static str,
    pub not_counted: &'static str,
    pub counted_of_others: &'static str,
    pub counted_inside: &'static str,
    pub known_error: &'static str,
    pub known_error_uncounted: &'static str,
    pub held_without_network: &'static str,
    pub known_error_single_car: &'static str,
    pub known_error_driven: &'static str,
    pub hinges: &'static str,
    pub warnings: &'static str,
    pub no_warnings: &'static str,
    pub warnings_told: &'static str,
    pub not_considered: &'static str,
    pub later_contacts_left_out: &'static str,
    pub who: &'static str,
    pub expert: &'static str,
    pub qualifications: &'static str,
    pub instruction: &'static str,
    pub not_stated: &'static str,
    pub materials: &'static str,
    pub material: &'static str,
    pub no_materials: &'static str,
    pub traced: &'static str,
    pub turns: &'static str,
    pub turns_of_courses: &'static str,
    pub comes_to_rest: &'static str,
    pub partly_at_rest: &'static str,
    pub lower_bounds: &'static str,
    pub at_rest: &'static str,
    pub still_moves: &'static str,
    pub end_hinges: &'static str,
    pub no_hinge: &'static str,
    pub nothing_drawn: &'static str,
    pub too_few_drawn: &'static str,
    pub several_courses: &'static str,
    pub courses_of_prior: &'static str,
    pub no_intervals: &'static str,
    pub too_few_to_say: &'static str,
    pub at_medians: &'static str,
    pub over_draws: &'static str,
    pub force_hinges: &'static str,
    pub impact_hinges: &'static str,
    pub hand_holds: &'static str,
    pub hand_hinges: &'static str,
    pub replay_hinges: &'static str,
    pub doubtful_record: &'static str,
    pub speed_hinges: &'static str,
    pub car_hinges: &'static str,
    pub share_hinges: &'static str,
}

/// The texts of the opinion in a language.
pub(super) fn opinion_words(language: Language) -> &'static OpinionWords {
    match language {
        Language::En => &EN,
        Language::De => &DE,
    }
}

const EN: OpinionWords = OpinionWords {
    question_and_answer: "Question and answer",
    of_variant: "Variant “{name}”: {answer}",
    nothing_to_say: "No answer of the case allows an opinion; what there is stands in section 1.",
    courses: "Courses of events",
    course: "What becomes of the struck vehicle",
    probability: "Probability",
    figures: "Figures; in brackets the interval that holds with a probability of 90 %",
    figures_in_doubt: "Figures; in brackets the interval of 90 %, as far as it can be relied on",
    figures_alone: "Figures, which have no intervals",
    figures_of_simulation: "Figures; in brackets components, and over the drawn vehicles the interval in which nine of \
        ten of them lie, where only what data sheets leave open is varied",
    figures_of_impact: "Figures, which have no intervals; in brackets components",
    differs: "what differs",
    first_variant: "the variant that the others are compared with",
    asked_alike: "asked as the first variant",
    without: "without",
    more: "; and {n} more, see section 3",
    notes: "notes",
    in_no_draw: "in no draw",
    how_sure: "How sure the answer is",
    not_counted: "For answers of this kind it was not counted how often their intervals held.",
    counted_of_others: "How often intervals held when they were tried says nothing about an answer that carries such \
        warnings.",
    counted_inside: "The case lies outside the domain (section 6); for such cases it was not counted by itself.",
    known_error: "The intervals were tried on computed collisions whose outcome was known; the known errors are in \
        section 7. The method was not validated against real collisions. The bounds are those of 95 % \
        confidence.",
    known_error_uncounted: "The known errors of the models are in section 7. The method was not validated against real \
        collisions.",
    held_without_network: "These intervals are those of motions by the contact law from the first touch on, without the \
        force network, of drivers whose conduct was known: what force network and open drivers add to the error of this \
        answer is not in them.",
    known_error_single_car: "The method was tried on single cars that the program simulated itself, and was not \
        validated against real ones; what is known of its model stands in section 7.",
    known_error_driven: "The model was compared with multibody models of cars; its known errors are in section 7. It was \
        not validated against real cars.",
    hinges: "What the answer hinges on",
    warnings: "Warnings",
    no_warnings: "The program gives no warning.",
    warnings_told: "What this means and what can be done is in section 6.",
    not_considered: "What was not considered",
    later_contacts_left_out: "Later contacts of this case: after the first one the cars meet again in {share} of the \
        motions, as the impact alone moves them, and this was not followed.",
    who: "Expert, instruction and materials",
    expert: "Expert: {text}",
    qualifications: "Qualifications: {text}",
    instruction: "Instruction: {text}",
    not_stated: "not stated",
    materials: "Materials:",
    material: "{name}, SHA-256 {sha256}",
    no_materials: "Materials: no files but the case itself.",
    traced: "Every figure of this opinion is traced in the annex, sections 1 to 10.",
    turns: "At the end the struck vehicle is turned by 90° or more with a probability of {quarter}, and by 180° or \
        more with a probability of {half}.",
    turns_of_courses: "Courses of events are told apart by the largest turn on the way, the other probabilities of a turn are those \
        at the end.",
    comes_to_rest: "It comes to rest within {limit} in {share} of the {n} draws, after a path of {distance}.",
    partly_at_rest: "It comes to rest within {limit} in {share} of the {n} draws; until then, or until it is followed no \
        further, it covers {distance}.",
    lower_bounds: "Since less than 95 % of the draws come to rest in that time, upper ends of times and distances are \
        lower bounds.",
    at_rest: "It is at rest {time} after the first contact.",
    still_moves: "{time} after the first contact it still has {speed} in the mean of the draws.",
    end_hinges: "Of the estimates of vehicle and road, the end depends most on: {hinges}.",
    no_hinge: "No single estimate of vehicle or road decides 10 % or more of the variance of place or heading at the \
        end; the rest is the force, the contact and the drivers.",
    nothing_drawn: "Nothing was drawn that the answer could be seen to depend on; it holds for the values of section \
        3 as they stand.",
    too_few_drawn: "Too few vehicles and roads were drawn to see what the answer depends on.",
    several_courses: "More than one course of events is possible, each with a speed of its own below; the figures over all \
        of them may be true of none.",
    courses_of_prior: "No evidence says which way the motion went to its end: these courses and their probabilities \
        follow from the assumptions alone.",
    no_intervals: "The particles allow no intervals.",
    too_few_to_say: "The particles do not allow to say what the speeds hinge on.",
    at_medians: "With each input at its median:",
    over_draws: "over the drawn vehicles",
    force_hinges: "The force follows from masses, velocities and the place of contact of section 3; how much it \
        changes with each of them was not computed.",
    impact_hinges: "The impulse follows from masses, velocities, place of contact, restitution and friction of \
        section 3; how much it changes with each of them was not computed.",
    hand_holds: "It holds if {holds}.",
    hand_hinges: "What one standard deviation more of each input changes, or 1 % of an exact one, stands in section 8.",
    replay_hinges: "The speed at the contact follows from the recorded one, and from what is taken of the time between \
        the last sample and the contact; how much it changes with each of these was not computed.",
    doubtful_record: "The record is doubtful in what the warnings in section 6 name, which is not in the interval.",
    speed_hinges: "{name}, as far as the evidence leaves it open: speed of the struck car {struck}, of the striking \
        car {striking}.",
    car_hinges: "{name}, as far as the evidence leaves it open: speed of the car {speed}.",
    share_hinges: "{name}: {place} of the variance of the place at the end, {heading} of that of the heading.",
};

const DE: OpinionWords = OpinionWords {
    question_and_answer: "Beweisfrage und Antwort",
    of_variant: "Variante „{name}“: {answer}",
    nothing_to_say: "Keine Antwort des Falls trägt ein Gutachten; was vorliegt, steht in Abschnitt 1.",
    courses: "Mögliche Geschehensabläufe",
    course: "Verbleib des gestoßenen Fahrzeugs",
    probability: "Wahrscheinlichkeit",
    figures: "Ergebnisse; in Klammern der Bereich, der mit einer Wahrscheinlichkeit von 90 % zutrifft",
    figures_in_doubt: "Ergebnisse; in Klammern der Bereich von 90 %, soweit auf ihn Verlass ist",
    figures_alone: "Ergebnisse, die kein Intervall haben",
    figures_of_simulation: "Ergebnisse; in Klammern Komponenten, über die gezogenen Fahrzeuge der Bereich, in dem neun von \
        zehn liegen; variiert wird nur, was Datenblätter offen lassen",
    figures_of_impact: "Ergebnisse, die kein Intervall haben; in Klammern Komponenten",
    differs: "Unterschied",
    first_variant: "Variante, mit der die anderen verglichen werden",
    asked_alike: "gefragt wie die erste Variante",
    without: "ohne",
    more: "; und {n} weitere, siehe Abschnitt 3",
    notes: "Anmerkungen",
    in_no_draw: "in keiner Ziehung",
    how_sure: "Wie sicher die Antwort ist",
    not_counted: "Für Antworten dieser Art wurde nicht gezählt, wie oft ihre Bereiche zutrafen.",
    counted_of_others: "Wie oft Bereiche bei der Erprobung zutrafen, sagt nichts über eine Antwort aus, für die solche \
        Warnungen gelten.",
    counted_inside: "Der Fall liegt außerhalb des Gültigkeitsbereichs (Abschnitt 6); für solche Fälle wurde nicht eigens \
        gezählt.",
    known_error: "Die Bereiche wurden an berechneten Zusammenstößen geprüft, deren Ausgang bekannt war; die bekannten \
        Fehler stehen in Abschnitt 7. Das Verfahren ist nicht an realen Unfällen validiert. Die Grenzen gelten \
        mit einer Sicherheit von 95 %.",
    known_error_uncounted: "Die bekannten Fehler der Modelle stehen in Abschnitt 7. Das Verfahren ist nicht an realen \
        Unfällen validiert.",
    held_without_network: "Gezählt wurde an Bewegungen nach dem Kontaktgesetz von der ersten Berührung an, ohne Kraftnetz \
        und mit bekanntem Verhalten der Fahrer: was Kraftnetz und offenes Verhalten zum Fehler dieser Antwort beitragen, \
        ist darin nicht enthalten.",
    known_error_single_car: "Das Verfahren wurde an einzelnen Fahrzeugen geprüft, die das Programm selbst berechnet \
        hat, und ist nicht an realen validiert; was von seinem Modell bekannt ist, steht in Abschnitt 7.",
    known_error_driven: "Das Modell wurde mit Mehrkörpermodellen von Fahrzeugen verglichen; seine bekannten Fehler stehen \
        in Abschnitt 7. Es ist nicht an realen Fahrzeugen validiert.",
    hinges: "Wovon die Antwort abhängt",
    warnings: "Warnungen",
    no_warnings: "Das Programm gibt keine Warnung aus.",
    warnings_told: "Bedeutung und Abhilfe: siehe Abschnitt 6.",
    not_considered: "Was nicht berücksichtigt wurde",
    later_contacts_left_out: "Weitere Kontakte in diesem Fall: Nach dem ersten treffen sich die Fahrzeuge in {share} der \
        Bewegungen wieder, soweit allein der Stoß sie bewegt; das ist nicht verfolgt.",
    who: "Sachverständiger, Auftrag und Anknüpfungstatsachen",
    expert: "Sachverständiger: {text}",
    qualifications: "Qualifikation: {text}",
    instruction: "Auftrag: {text}",
    not_stated: "keine Angabe",
    materials: "Unterlagen:",
    material: "{name}, SHA-256 {sha256}",
    no_materials: "Unterlagen: keine Dateien außer dem Fall selbst.",
    traced: "Jede Zahl dieses Gutachtens ist im Anhang, Abschnitte 1 bis 10, nachzuvollziehen.",
    turns: "Am Ende ist das gestoßene Fahrzeug mit einer Wahrscheinlichkeit von {quarter} um 90° oder mehr gedreht, mit \
        einer Wahrscheinlichkeit von {half} um 180° oder mehr.",
    turns_of_courses: "Die Geschehensabläufe sind nach der größten Drehung während der Bewegung unterschieden, die übrigen \
        Wahrscheinlichkeiten einer Drehung gelten für das Ende.",
    partly_at_rest: "Es kommt in {share} der {n} Ziehungen innerhalb von {limit} zum Stillstand; bis dahin, oder bis es nicht \
        weiter verfolgt wird, legt es {distance} zurück.",
    comes_to_rest: "Es kommt in {share} der {n} Ziehungen innerhalb von {limit} zum Stillstand, nach einem Weg von \
        {distance}.",
    lower_bounds: "Da in dieser Zeit weniger als 95 % der Ziehungen zum Stillstand kommen, sind die oberen Enden von \
        Zeiten und Wegen untere Schranken.",
    at_rest: "{time} nach dem ersten Kontakt steht es still.",
    still_moves: "{time} nach dem ersten Kontakt hat es im Mittel der Ziehungen noch {speed}.",
    end_hinges: "Von den Schätzwerten für Fahrzeug und Fahrbahn bestimmen das Ende vor allem: {hinges}.",
    no_hinge: "Kein Schätzwert für Fahrzeug oder Fahrbahn bestimmt 10 % oder mehr der Varianz von Ort oder Winkel \
        am Ende; das Übrige sind Kraft, Kontakt und Fahrer.",
    nothing_drawn: "Es wurde nichts gezogen, woran eine Abhängigkeit zu erkennen wäre; die Antwort gilt für die Werte \
        in Abschnitt 3, so wie sie dort stehen.",
    too_few_drawn: "Es wurden zu wenige Fahrzeuge und Fahrbahnen gezogen, um zu erkennen, wovon die Antwort abhängt.",
    several_courses: "Mehr als ein Geschehensablauf ist möglich, jeder mit einer eigenen Geschwindigkeit, siehe unten; \
        die Zahlen über alle treffen womöglich auf keinen zu.",
    courses_of_prior: "Zum weiteren Verlauf der Bewegung fehlen Anknüpfungstatsachen: Diese Geschehensabläufe und ihre \
        Wahrscheinlichkeiten folgen allein aus den Annahmen.",
    no_intervals: "Für Bereiche reichen die Ziehungen nicht aus.",
    too_few_to_say: "Die Ziehungen lassen keine Aussage darüber zu, wovon die Geschwindigkeiten abhängen.",
    at_medians: "Mit jeder Eingangsgröße in ihrem Median:",
    over_draws: "über die gezogenen Fahrzeuge",
    force_hinges: "Die Kraft folgt aus Massen, Geschwindigkeiten und Kontaktort in Abschnitt 3; wie stark sie sich mit \
        jedem davon ändert, wurde nicht berechnet.",
    impact_hinges: "Der Impuls folgt aus Massen, Geschwindigkeiten, Kontaktort, Stoßziffer und Reibbeiwert in Abschnitt \
        3; wie stark er sich mit jedem davon ändert, wurde nicht berechnet.",
    hand_holds: "Voraussetzung: {holds}.",
    hand_hinges: "Was eine Standardabweichung mehr jeder Eingabe oder 1 % einer genauen ändert, steht in Abschnitt 8.",
    replay_hinges: "Die Geschwindigkeit beim Kontakt folgt aus der aufgezeichneten und aus dem, was für die Zeit zwischen \
        dem letzten Abtastwert und dem Kontakt angenommen ist; wie stark sie sich mit jedem davon ändert, wurde nicht \
        berechnet.",
    doubtful_record: "Die Aufzeichnung ist in dem zweifelhaft, was die Warnungen in Abschnitt 6 nennen; im angegebenen \
        Bereich ist das nicht enthalten.",
    speed_hinges: "{name}, soweit die Spuren dies offenlassen: Geschwindigkeit des gestoßenen Fahrzeugs {struck}, des \
        stoßenden {striking}.",
    car_hinges: "{name}, soweit die Spuren dies offenlassen: Geschwindigkeit des Fahrzeugs {speed}.",
    share_hinges: "{name}: {place} der Varianz des Endorts, {heading} der des Endwinkels.",
};

#[cfg(test)]
mod tests {
    use super::*;

    /// “in 97.5 % of the draws” did not say how many these were.
    #[test]
    fn a_share_of_draws_is_told_with_their_number() {
        for words in [Language::En, Language::De].map(opinion_words) {
            for template in [words.comes_to_rest, words.partly_at_rest] {
                assert!(template.contains("{share}") && template.contains("{n}"), "{template}");
            }
        }
    }
}
