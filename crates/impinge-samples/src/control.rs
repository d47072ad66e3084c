//! Controls of a sample: numbers, choices, flags and buttons, by name.

use std::collections::BTreeSet;

use impinge::math::Real;
use serde::Serialize;

use crate::SampleError;

/// The kind of a control, and its value. It serializes with its name in lower case as the member `kind`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ControlKind {
    /// A number between bounds.
    Number {
        /// The value.
        value: f64,
        /// The least value.
        min: f64,
        /// The greatest value.
        max: f64,
        /// The step of a slider; values between are accepted.
        step: f64,
    },
    /// One of several words.
    Choice {
        /// The word.
        value: &'static str,
        /// All words.
        choices: &'static [&'static str],
    },
    /// Yes or no.
    Flag {
        /// The value.
        value: bool,
    },
    /// An action that runs once, at the next step.
    Button,
}

/// A control, as a page displays it. It serializes as one object of all its members.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Control {
    /// The unique name within a sample.
    pub name: &'static str,
    /// The text beside it.
    pub label: &'static str,
    /// Kind and value.
    #[serde(flatten)]
    pub kind: ControlKind,
}

/// A value for a control.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlValue {
    /// The value of a number.
    Number(f64),
    /// The value of a choice.
    Choice(String),
    /// The value of a flag.
    Flag(bool),
    /// A press of a button.
    Pressed,
}

/// The controls of a sample, declared once as a table, in the order of the page.
///
/// ```
/// use impinge_samples::{ControlValue, Panel, SampleError};
///
/// let mut panel = Panel::new()
///     .number("speed", "Speed", 1.0, [0.0, 5.0, 0.1])
///     .choice("shape", "Shape", "ball", &["ball", "box"])
///     .button("drop", "Drop one");
/// panel.set("speed", &ControlValue::Number(2.5))?;
/// panel.set("drop", &ControlValue::Pressed)?;
/// assert_eq!((panel.value("speed"), panel.chosen("shape")), (2.5, "ball"));
/// assert!(panel.take_press("drop") && !panel.take_press("drop"), "it is done once");
///
/// let error = panel.set("speed", &ControlValue::Number(f64::NAN)).expect_err("NaN is in no range");
/// assert_eq!(error.to_string(), "speed is NaN, not from 0 to 5");
/// # Ok::<(), SampleError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// In the order in which they were declared.
    controls: Vec<Control>,
    /// The names of the pressed buttons whose action has not run yet.
    pressed: BTreeSet<&'static str>,
}

impl Panel {
    /// Creates a panel without controls.
    #[must_use]
    pub const fn new() -> Self {
        Self { controls: Vec::new(), pressed: BTreeSet::new() }
    }

    /// Adds a number with its initial value, minimum, maximum and step.
    #[must_use]
    pub fn number(
        self,
        name: &'static str,
        label: &'static str,
        value: f64,
        [min, max, step]: [f64; 3],
    ) -> Self {
        self.with(name, label, ControlKind::Number { value, min, max, step })
    }

    /// Adds a choice with its initial word and all words.
    #[must_use]
    pub fn choice(
        self,
        name: &'static str,
        label: &'static str,
        value: &'static str,
        choices: &'static [&'static str],
    ) -> Self {
        self.with(name, label, ControlKind::Choice { value, choices })
    }

    /// Adds a flag.
    #[must_use]
    pub fn flag(self, name: &'static str, label: &'static str, value: bool) -> Self {
        self.with(name, label, ControlKind::Flag { value })
    }

    /// Adds a button.
    #[must_use]
    pub fn button(self, name: &'static str, label: &'static str) -> Self {
        self.with(name, label, ControlKind::Button)
    }

    fn with(mut self, name: &'static str, label: &'static str, kind: ControlKind) -> Self {
        self.controls.push(Control { name, label, kind });
        self
    }

    /// The controls, in order.
    #[must_use]
    pub fn controls(&self) -> &[Control] {
        &self.controls
    }

    /// Sets a control; an invalid value changes nothing.
    ///
    /// # Errors
    /// If no control has the name, or the value is of another kind, out of bounds, NaN, or not one of the
    /// words.
    pub fn set(&mut self, name: &str, value: &ControlValue) -> Result<(), SampleError> {
        let control = self.controls.iter_mut().find(|control| control.name == name);
        let control = control.ok_or_else(|| SampleError::UnknownControl(name.to_owned()))?;
        let name = control.name;
        match (&mut control.kind, value) {
            (ControlKind::Number { value, min, max, .. }, ControlValue::Number(wanted)) => {
                if !(*min..=*max).contains(wanted) {
                    let (value, bounds) = (*wanted, [*min, *max]);
                    return Err(SampleError::OutOfBounds { name, value, bounds });
                }
                *value = *wanted;
            }
            (ControlKind::Choice { value, choices }, ControlValue::Choice(wanted)) => {
                let known = choices.iter().find(|choice| *choice == wanted);
                let refused = || SampleError::UnknownChoice { name, value: wanted.clone() };
                *value = known.ok_or_else(refused)?;
            }
            (ControlKind::Flag { value }, ControlValue::Flag(wanted)) => *value = *wanted,
            (ControlKind::Button, ControlValue::Pressed) => {
                self.pressed.insert(name);
            }
            (_, wanted) => {
                return Err(SampleError::WrongKind { name, value: wanted.clone() });
            }
        }
        Ok(())
    }

    fn find(&self, name: &str) -> Option<&ControlKind> {
        self.controls.iter().find(|control| control.name == name).map(|control| &control.kind)
    }

    /// The value of a number as a scalar of samples; 0 if there is no number of this name.
    #[must_use]
    pub fn value(&self, name: &str) -> f32 {
        match self.find(name) {
            Some(ControlKind::Number { value, .. }) => f32::lit(*value),
            _ => 0.0,
        }
    }

    /// The value of a number as a count, rounded down; 0 if there is no number of this name.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates, and is rounded down as documented"
    )]
    pub fn count(&self, name: &str) -> usize {
        match self.find(name) {
            Some(ControlKind::Number { value, .. }) => *value as usize,
            _ => 0,
        }
    }

    /// Returns the word of a choice; the empty word if there is no choice of this name.
    #[must_use]
    pub fn chosen(&self, name: &str) -> &'static str {
        match self.find(name) {
            Some(ControlKind::Choice { value, .. }) => value,
            _ => "",
        }
    }

    /// Returns the value of a flag; `false` if there is no flag of this name.
    #[must_use]
    pub fn is_set(&self, name: &str) -> bool {
        matches!(self.find(name), Some(ControlKind::Flag { value: true }))
    }

    /// Returns whether a button was pressed, and resets it: the next call returns `false`.
    pub fn take_press(&mut self, name: &str) -> bool {
        self.pressed.remove(name)
    }
}
