//! The little English that one needs to follow the tutorial: a text as things to do, in order.

/// What a clause asks for. Keys and buttons are named as they stand on the screen.
#[derive(Clone, Debug, PartialEq)]
pub enum Act {
    /// A new sentence: one makes up one's mind.
    Mind,
    /// A key or button, so many times.
    Press(String, usize),
    /// A tile or tab of the library, by its name, so many times.
    Click(String, usize),
    /// D-pad to a tile.
    Choose(String),
    /// All of it, so many times more.
    Again(usize),
    /// A button of the gamepad until the library shows that category.
    TurnTo(String, String),
    /// The pointer, or the hand, is over a thing.
    PointAt(String),
    /// Select a thing.
    Select(String),
    /// Up, by the green arrow, so that it is as high as something.
    LiftByArrow(String, String),
    /// The red ring by a quarter turn.
    TurnByRing,
    /// To a place in words; whether the wheel lifts it meanwhile.
    Drag(String, String, bool),
    /// The mouse alone, to the left.
    MoveLeft,
    /// A button of the gamepad goes down and stays.
    Hold(String),
    /// What is held goes to a place in words.
    Push(String),
    /// What is held goes up.
    Lift(String),
    /// Turned with this button held.
    Turn(String),
    /// The stick to the left.
    PushLeft,
    LetGo,
    /// Through the panels by a button, then these by name.
    GoTo(String, Vec<String>),
    /// What was made last is called so from now on.
    Called(String),
}

/// What a text asks for, clause by clause; what is only told is left out.
pub fn acts(text: &str) -> Vec<Act> {
    let mut acts = Vec::new();
    // "The library is closed: L opens it again." comes before everything else.
    let opens = text
        .split(": ")
        .find_map(|s| s.split_once(" opens it again"));
    acts.extend(opens.map(|(key, _)| Act::Press(key.to_owned(), 1)));
    for sentence in text.split(". ") {
        let sentence = sentence.trim_end_matches('.');
        let wheel = sentence.contains("wheel up");
        let begun = acts.len();
        for clause in split(sentence) {
            let clause = clause.trim();
            let before = acts.iter().rfind(|a| **a != Act::Mind);
            match clause_acts(clause, wheel, before) {
                Some(found) => acts.extend(found),
                None => {
                    if let Some(name) = clause.strip_prefix("the ") {
                        let made = |a: &Act| matches!(a, Act::Click(..) | Act::Choose(..));
                        if acts.iter().any(made) {
                            let name = name.split(" of ").next().unwrap();
                            acts.push(Act::Called(name.to_owned()));
                        }
                    }
                }
            }
        }
        if acts.len() > begun {
            acts.insert(begun, Act::Mind);
        }
    }
    acts
}

/// Clauses: between `: `, `; ` and before `, then `, ` and press `, ` and hold ` and the like.
fn split(sentence: &str) -> Vec<String> {
    let mut text = sentence.replace("; ", "|").replace(": ", "|");
    for (from, to) in [
        (", then drag", "|drag"),
        (", then ", "|click "),
        (" and press ", "|press "),
        (", hold ", "|hold "),
        (" and hold ", "|hold "),
        (" and push ", "|push "),
        (" and lift ", "|lift "),
        (" and move the mouse ", "|move the mouse "),
        (", there ", "|there "),
    ] {
        text = text.replace(from, to);
    }
    text.split('|').map(str::to_owned).collect()
}

fn clause_acts(clause: &str, wheel: bool, before: Option<&Act>) -> Option<Vec<Act>> {
    let lower = clause.to_lowercase();
    let after = |start: &str| {
        lower
            .strip_prefix(start)
            .map(|_| clause[start.len()..].to_owned())
    };
    let noun = |s: &str| {
        let s = s.trim_start_matches("the ").trim();
        s.trim_end_matches(" you made").to_owned()
    };
    let times = |s: &str| match s {
        s if s.ends_with("four times") => (s.trim_end_matches("four times").trim().to_owned(), 4),
        s if s.ends_with("twice") => (s.trim_end_matches("twice").trim().to_owned(), 2),
        s => (s.to_owned(), 1),
    };
    if lower == "four times" {
        return Some(vec![Act::Again(3)]);
    }
    if lower == "let go" {
        return Some(vec![Act::LetGo]);
    }
    if lower == "click to end it" {
        return Some(vec![Act::Press("click".into(), 1)]);
    }
    if let Some(rest) = after("press ") {
        // "Press L, or click Library above": the first will do.
        let rest = rest.split(", ").next().unwrap().to_owned();
        let (rest, count) = times(&rest);
        if let Some((key, _)) = rest.split_once(" until you are in the bar") {
            return Some(vec![Act::GoTo(key.to_owned(), Vec::new())]);
        }
        let key = rest
            .trim_end_matches(" again")
            .trim_end_matches(" in the air");
        return Some(vec![Act::Press(key.to_owned(), count)]);
    }
    if let Some(rest) = after("there ")
        && matches!(before, Some(Act::GoTo(..)))
    {
        let (_, names) = rest.split_once(" on ")?;
        let steps = names.split(" and on ").map(str::to_owned);
        return Some(vec![Act::GoTo(String::new(), steps.collect())]);
    }
    if let Some(rest) = after("choose ") {
        let name = rest.replace(" with the D-pad", "");
        return Some(vec![Act::Choose(name)]);
    }
    if let Some((key, category)) = clause.split_once(" turns to ") {
        return Some(vec![Act::TurnTo(key.to_owned(), category.to_owned())]);
    }
    if let Some(rest) = after("click ") {
        if rest.starts_with("the ") {
            return Some(vec![Act::Select(noun(&rest))]);
        }
        let (name, count) = times(&rest);
        let name = name.replace(" in the library", "");
        return Some(vec![Act::Click(name.trim().to_owned(), count)]);
    }
    if let Some(rest) = after("point at ").or(after("move onto ")) {
        let rest = rest.replace(" with the left stick", "");
        return Some(vec![Act::PointAt(noun(&rest))]);
    }
    if let Some(rest) = after("drag its green arrow up, ") {
        let Some(Act::Select(what)) = before else {
            return None;
        };
        return Some(vec![Act::LiftByArrow(what.clone(), rest)]);
    }
    if lower.starts_with("drag the red ring") {
        return Some(vec![Act::TurnByRing]);
    }
    if let Some(rest) = after("drag ") {
        let rest = rest.split(", so").next().unwrap();
        for to in [" to ", " under ", " halfway into ", " into "] {
            if let Some((what, place)) = rest.split_once(to) {
                return Some(vec![Act::Drag(
                    noun(what),
                    format!("{}{place}", &to[1..]),
                    wheel,
                )]);
            }
        }
        return None;
    }
    if lower.starts_with("move the mouse left") {
        return Some(vec![Act::MoveLeft]);
    }
    if let Some(rest) = after("hold ") {
        return Some(vec![Act::Hold(rest)]);
    }
    if let Some(rest) = after("push it ") {
        return Some(vec![Act::Push(rest)]);
    }
    if let Some(rest) = after("push left") {
        return ["", " again"]
            .contains(&rest.as_str())
            .then(|| vec![Act::PushLeft]);
    }
    if let Some(rest) = after("lift it ") {
        return Some(vec![Act::Lift(rest)]);
    }
    let other = [" goes on with the other hand", " lets go the other hand"];
    if let Some((key, _)) = other.iter().find_map(|o| clause.split_once(o)) {
        return Some(vec![Act::Press(key.to_owned(), 1)]);
    }
    if lower.starts_with("with ")
        && let Some((key, _)) = clause[5..].split_once(" the right stick turns it")
    {
        return Some(vec![Act::Turn(key.to_owned())]);
    }
    None
}

#[test]
fn what_the_tutorial_says_is_understood() {
    use Act::*;
    let s = str::to_owned;
    let acts = |text: &str| {
        let mut all = super::words::acts(text);
        all.retain(|a| *a != Mind);
        all
    };
    assert_eq!(
        acts("Click Chair in the library, then Cushion: the seat."),
        [
            Click(s("Chair"), 1),
            Click(s("Cushion"), 1),
            Called(s("seat"))
        ]
    );
    assert_eq!(
        acts("Press L, or click Library above: the library opens."),
        [Press(s("L"), 1)]
    );
    assert_eq!(
        acts("Click the seat, then drag its green arrow up, as high as a seat is: about 40 cm."),
        [
            Select(s("seat")),
            LiftByArrow(s("seat"), s("as high as a seat is"))
        ]
    );
    assert_eq!(
        acts("Point at each leg and press U. Point at the back and press U."),
        [
            PointAt(s("each leg")),
            Press(s("U"), 1),
            PointAt(s("back")),
            Press(s("U"), 1)
        ]
    );
    assert_eq!(
        acts("Move onto the seat, hold RB and lift it as high as a seat is: about 40 cm. Let go."),
        [
            PointAt(s("seat")),
            Hold(s("RB")),
            Lift(s("as high as a seat is")),
            LetGo
        ]
    );
    assert_eq!(
        acts("Press L3: back to the library. Choose Round leg and press A; four times."),
        [
            Press(s("L3"), 1),
            Choose(s("Round leg")),
            Press(s("A"), 1),
            Again(3),
        ]
    );
    assert_eq!(acts("Only what both share will stay."), []);
}
