//! The controls of a sample: numbers, choices, flags and buttons, identified by names.

use std::collections::BTreeSet;

use impinge::math::Real;
use serde::Serialize;

use crate::SampleError;

/// The kind of a control, with its value. It serializes with the name of the variant in lower case
/// as the member `kind`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ControlKind {
    /// A number between bounds.
    Number {
        /// The current value.
        value: f64,
        /// The smallest value.
        min: f64,
        /// The largest value.
        max: f64,
        /// The increment of a slider; 0 for a continuous slider. [`Panel::set`] accepts any value
        /// within the bounds.
        step: f64,
    },
    /// One of several words.
    Choice {
        /// The chosen word.
        value: &'static str,
        /// All words that can be chosen.
        choices: &'static [&'static str],
    },
    /// A value that is true or false.
    Flag {
        /// The current value.
        value: bool,
    },
    /// A button. Its action runs once after a press, at the next step.
    Button,
}

/// A control, as a page displays it. It serializes as one object with the members of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Control {
    /// The unique name within a sample.
    pub name: &'static str,
    /// The text beside the control.
    pub label: &'static str,
    /// The kind, with the value.
    #[serde(flatten)]
    pub kind: ControlKind,
}

/// A new value for a control.
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

/// The controls of a sample, in the order in which a page shows them.
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
    /// The controls in the order in which they were declared.
    controls: Vec<Control>,
    /// The names of the buttons that were pressed and whose action has not run yet.
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

    /// Adds a choice with its initial word and the list of all words.
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

    /// Adds a flag with its initial value.
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

    /// Returns the controls in the order in which they were declared.
    #[must_use]
    pub fn controls(&self) -> &[Control] {
        &self.controls
    }

    /// Sets the value of a control. An invalid value changes nothing.
    ///
    /// # Errors
    /// If no control has the name, or if the value is of another kind, out of bounds, NaN, or not
    /// one of the words.
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

    /// Returns the value of a number; 0 if there is no number with this name.
    #[must_use]
    pub fn value(&self, name: &str) -> f32 {
        match self.find(name) {
            Some(ControlKind::Number { value, .. }) => f32::lit(*value),
            _ => 0.0,
        }
    }

    /// Returns the value of a number rounded down to a count; 0 if there is no number with this
    /// name.
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

    /// Returns the word of a choice; the empty word if there is no choice with this name.
    #[must_use]
    pub fn chosen(&self, name: &str) -> &'static str {
        match self.find(name) {
            Some(ControlKind::Choice { value, .. }) => value,
            _ => "",
        }
    }

    /// Returns the value of a flag; `false` if there is no flag with this name.
    #[must_use]
    pub fn is_set(&self, name: &str) -> bool {
        matches!(self.find(name), Some(ControlKind::Flag { value: true }))
    }

    /// Returns `true` if a button was pressed since the last call for this button. The next call
    /// returns `false` unless the button is pressed again.
    pub fn take_press(&mut self, name: &str) -> bool {
        self.pressed.remove(name)
    }
}
