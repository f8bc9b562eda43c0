//! How things stand with the headset, and what is said about it.

use bevy::prelude::*;
use midair_studio::notice::Notices;
use openxr::SessionState;

use super::Link;

/// How things stand with the headset.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Life {
    /// It is not used.
    #[default]
    Flat,
    /// A session is there and has not been worn yet.
    Waiting,
    /// It sleeps, or lies on the table.
    Asleep,
    /// It shows Midair, but another window has the controllers.
    Shown,
    /// It shows Midair, and the controllers are Midair's.
    Focused,
    /// The runtime is gone; it is looked for.
    Lost,
}

impl Life {
    /// Whether somebody sees Midair in the headset.
    pub fn is_worn(self) -> bool {
        matches!(self, Self::Shown | Self::Focused)
    }

    /// From one to the next.
    fn next(self, link: &Link) -> Self {
        if !link.is_open() {
            return if link.is_wanted() && (link.is_searching() || self == Self::Lost) {
                Self::Lost
            } else {
                Self::Flat
            };
        }
        match link.state() {
            SessionState::FOCUSED => Self::Focused,
            SessionState::VISIBLE => Self::Shown,
            _ if matches!(self, Self::Focused | Self::Shown | Self::Asleep) => Self::Asleep,
            _ => Self::Waiting,
        }
    }
}

pub(super) fn follow(
    link: Res<Link>,
    mut life: ResMut<Life>,
    mut notices: ResMut<Notices>,
    time: Option<Res<Time<Real>>>,
    mut begun: Local<Option<f64>>,
) {
    let now = time.map_or(0.0, |t| t.elapsed_secs_f64());
    let start = *begun.get_or_insert(now);
    let next = life.next(&link);
    if next == *life {
        return;
    }
    info!(target: "midair_openxr::life", "{:?} -> {next:?} after {:.2} s", *life, now - start);
    let line = said(*life, next, &link);
    match line {
        Some((true, text)) => notices.warn(text),
        Some((false, text)) => notices.info(text),
        None => {}
    }
    *life = next;
}

/// What is said when things change: whether it is a warning, and the line.
fn said(from: Life, to: Life, link: &Link) -> Option<(bool, String)> {
    use Life::{Asleep, Flat, Focused, Lost, Shown, Waiting};
    let text = match (from, to) {
        (Shown, Focused) => "The controllers are Midair's again.".to_owned(),
        (_, Focused) => format!("Midair is in the headset ({}).", link.name()),
        (Focused, Shown) => {
            "Another window has the controllers. Close it in the headset to go on; what you were doing is kept."
                .to_owned()
        }
        (_, Asleep) => {
            "The headset sleeps. Put it on to go on; until then mouse and keyboard work here.".to_owned()
        }
        (_, Waiting) => format!(
            "{} is found. Put the headset on to go on there; mouse and keyboard work here.",
            link.name()
        ),
        // Whoever lost it has said why.
        (_, Lost) | (Lost, Flat) | (Flat, Shown) => return None,
        (_, Flat) => "The headset is left. Your work is here, with mouse and keyboard; File, Enter the headset goes back."
            .to_owned(),
        _ => return None,
    };
    Some((false, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_follows_from_what_the_runtime_says() {
        let mut link = Link::default();
        assert_eq!(Life::Flat.next(&link), Life::Flat);
        link.pretend(SessionState::READY);
        assert_eq!(Life::Flat.next(&link), Life::Waiting);
        link.pretend(SessionState::FOCUSED);
        assert_eq!(Life::Waiting.next(&link), Life::Focused);
        link.pretend(SessionState::VISIBLE);
        assert_eq!(Life::Focused.next(&link), Life::Shown);
        for asleep in [SessionState::SYNCHRONIZED, SessionState::IDLE] {
            link.pretend(asleep);
            assert_eq!(Life::Focused.next(&link), Life::Asleep);
        }
    }

    #[test]
    fn each_change_that_a_person_notices_has_its_line() {
        let link = Link::default();
        for (from, to) in [
            (Life::Waiting, Life::Focused),
            (Life::Focused, Life::Shown),
            (Life::Focused, Life::Asleep),
            (Life::Focused, Life::Flat),
            (Life::Lost, Life::Focused),
        ] {
            let (_, line) = said(from, to, &link).unwrap();
            assert!(!line.contains('\n') && line.ends_with('.'), "{line}");
        }
    }
}
