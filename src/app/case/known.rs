//! What is known of the case as it is now, which is found anew only when the case has changed: a window that
//! plays a motion draws many frames of the same case.

use crate::app::case::OpenCase;
use crate::app::project::Project;
use crate::app::state::State;
use impactlab_study::case_file::Variant;

/// The case as it is now.
#[derive(Default)]
pub struct KnownCase {
    /// From what it was found.
    of: Option<(Project, OpenCase)>,
    /// Whether the case has something that is not in its file.
    pub is_changed: bool,
    /// Its variants, with the project in the one that is shown.
    pub variants: Vec<Variant>,
}

impl State {
    /// Finds what is known of the case, if the case or the project has changed.
    pub(in crate::app) fn update_known_case(&mut self) {
        let project = self.project_of_questions();
        let known = &mut self.session.known_case;
        let is_same =
            known.of.as_ref().is_some_and(|(of, case)| *of == project && *case == self.case);
        if !is_same {
            *known = KnownCase {
                is_changed: self.case.is_changed(&project),
                variants: self.case.with_shown(&project).variants,
                of: Some((project, self.case.clone())),
            };
        }
    }
}
