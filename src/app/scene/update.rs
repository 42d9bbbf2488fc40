//! The forecast in the scene.

use std::sync::Arc;

use egui::Context;

use crate::app::command::wake;
use crate::app::response::DensityQuestion;
use crate::app::scene::session::ShownForecast;
use crate::app::state::{Session, State, View};

impl State {
    /// Asks for the density at the end of the forecast while the scene shows that.
    pub(in crate::app) fn update_scene(&mut self, context: &Context) {
        let Session { scene, response, library, .. } = &mut self.session;
        scene.end_density.poll();
        let motion = response.forecast.ok().filter(|_| self.view.scene.shows_forecast).cloned();
        match motion {
            Some(motion) => {
                let (window_s, gpu) = ([motion.end_s(); 2], response.gpu.clone());
                let question = DensityQuestion { motion, window_s, gpu };
                scene.end_density.ask(question, library, wake(context));
            }
            None => scene.end_density.forget(),
        }
    }

    /// The forecast in the scene: the one that is of what is asked now, if it is to be shown.
    pub(in crate::app) fn shown_forecast(view: &View, session: &Session) -> Option<ShownForecast> {
        let forecast = &session.response.forecast;
        let is_shown = view.scene.shows_forecast && !session.is_motion_late();
        let motion = forecast.ok().filter(|_| is_shown)?;
        let density = session.scene.end_density.ok().cloned();
        Some(ShownForecast {
            motion: Arc::clone(motion),
            density: density.filter(|density| Arc::ptr_eq(&density.motion, motion)),
        })
    }
}
