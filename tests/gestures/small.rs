//! Every panel in windows of every size and at every scale.

use midair_studio::panel::Panels;
use midair_studio::settings::{Lesson, Settings};

use crate::desk::Desk;

impl Desk {
    fn window(&mut self, width: f32, height: f32) {
        self.resize(width, height);
        self.wait(3);
    }

    fn regions(&self) -> Vec<&'static str> {
        self.focus().regions().iter().map(|r| r.name).collect()
    }

    fn alone(&mut self, id: &str) {
        let mut panels = self.app.world_mut().resource_mut::<Panels>();
        for info in panels.all().to_vec() {
            panels.set_open(info.id, info.id == id);
        }
        self.wait(3);
    }
}

#[test]
fn every_panel_is_drawn_in_windows_of_every_size() {
    let mut desk = Desk::new();
    let panels = desk.world().resource::<Panels>().all().to_vec();
    for info in panels {
        desk.alone(info.id);
        for (width, height) in [
            (200.0, 100.0),
            (40.0, 30.0),
            (640.0, 360.0),
            (2560.0, 1440.0),
        ] {
            desk.window(width, height);
        }
        for scale in [0.5, 2.5] {
            let mut settings = desk.app.world_mut().resource_mut::<Settings>();
            settings.look.interface_scale = scale;
            desk.window(1280.0, 720.0);
        }
        let mut settings = desk.app.world_mut().resource_mut::<Settings>();
        settings.look.interface_scale = 1.0;
    }
}

#[test]
fn a_tiny_window_keeps_the_bar_and_a_grown_one_has_everything_again() {
    let mut desk = Desk::new();
    desk.alone("library");
    assert!(desk.regions().contains(&"library"));
    desk.window(200.0, 100.0);
    assert!(desk.regions().contains(&"bar"), "{:?}", desk.regions());
    assert!(!desk.regions().contains(&"library"));
    assert!(desk.is_open("library"), "it is only out of sight");
    desk.window(1280.0, 720.0);
    assert!(desk.regions().contains(&"library"));
    assert!(desk.regions().contains(&"bar"));
}

#[test]
fn every_state_of_the_tutorial_is_drawn() {
    let mut desk = Desk::new();
    desk.alone("tutorial");
    for state in [Lesson::Offered, Lesson::Going, Lesson::Left, Lesson::Done] {
        let mut settings = desk.app.world_mut().resource_mut::<Settings>();
        settings.help.tutorial.state = state;
        desk.wait(3);
        assert!(desk.regions().contains(&"tutorial"), "{state:?}");
    }
}
