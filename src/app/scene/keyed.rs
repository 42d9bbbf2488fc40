//! The camera of a scene in the window that moves with the time between its keys.

use crate::app::scene::SceneSettings;
use impactlab_document::scene::Scene;
use impactlab_draw::scene::{Camera, CameraKey, ViewKind, camera_in_scene};

/// For which time and view the camera was last where its keys have it.
#[derive(Debug, Default)]
pub struct KeyedCamera {
    shown: Option<(f64, ViewKind)>,
}

impl KeyedCamera {
    /// The camera that the keys give at a time, once for that time, so that the user can move it while the
    /// time stands. The car that is followed becomes that of the keys.
    ///
    /// - returns `None` where the camera stays as it is, also if the keys are not to be shown.
    pub fn at(
        &mut self,
        keys: &[CameraKey],
        settings: &mut SceneSettings,
        (scene, time_s): (&Scene, f64),
    ) -> Option<Camera> {
        let now = (time_s, settings.camera.kind);
        let key = camera_in_scene(keys, scene, time_s).filter(|_| settings.shows_keyed_camera);
        let before = std::mem::replace(&mut self.shown, key.map(|_| now));
        let key = key.filter(|_| before != Some(now))?;
        settings.follow = key.follow;
        Some(key.camera(settings.camera.kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_draw::scene::Follow;

    #[test]
    fn the_camera_goes_with_the_time_and_is_free_while_it_stands() {
        let (scene, start) = (Scene::default(), Camera::default());
        let far = Camera { distance_m: 200.0, ..start };
        let keys = [
            CameraKey::new(0.0, &start, Follow::Nothing),
            CameraKey::new(1.0, &far, Follow::Struck),
        ];
        let (mut keyed, mut settings) = (KeyedCamera::default(), SceneSettings::default());
        assert_eq!(keyed.at(&keys, &mut settings, (&scene, 0.0)), None, "it is not to be shown");
        settings.shows_keyed_camera = true;
        let first = keyed.at(&keys, &mut settings, (&scene, 0.0)).unwrap();
        assert_eq!(first.distance_m, start.distance_m);
        assert_eq!(keyed.at(&keys, &mut settings, (&scene, 0.0)), None, "the time stands");
        let middle = keyed.at(&keys, &mut settings, (&scene, 0.5)).unwrap();
        assert!(middle.distance_m > start.distance_m && middle.distance_m < far.distance_m);
        let last = keyed.at(&keys, &mut settings, (&scene, 1.0)).unwrap();
        assert_eq!((last.distance_m, settings.follow), (far.distance_m, Follow::Struck));
        settings.camera.kind = ViewKind::Perspective;
        let turned = keyed.at(&keys, &mut settings, (&scene, 1.0)).map(|camera| camera.kind);
        assert_eq!(turned, Some(ViewKind::Perspective));
        settings.shows_keyed_camera = false;
        assert_eq!(keyed.at(&keys, &mut settings, (&scene, 0.2)), None);
        settings.shows_keyed_camera = true;
        assert!(keyed.at(&keys, &mut settings, (&scene, 0.2)).is_some(), "it is shown at once");
        assert_eq!(keyed.at(&[], &mut settings, (&scene, 0.3)), None);
    }
}
