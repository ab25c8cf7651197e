//! A frame with the contacts and bonds of its time, which come as messages of their own.

use super::{Contacts, Frame, RunMessage};
use crate::Bonds;

/// Gathers the messages of one time.
#[derive(Default)]
pub(crate) struct Gathered {
    frame: Option<Frame>,
    contacts: Option<Contacts>,
    bonds: Option<Bonds>,
}

/// What a run has of one time.
pub(crate) struct TimeSlice {
    pub frame: Frame,
    /// Its contacts, where the run recorded them.
    pub contacts: Option<Contacts>,
    /// Its bonds, where the run recorded them.
    pub bonds: Option<Bonds>,
}

impl Gathered {
    /// Adds a message; the frame of another time than that of the message is complete, and is returned.
    pub fn add(&mut self, message: RunMessage) -> Option<TimeSlice> {
        let time = match &message {
            RunMessage::Frame(frame) => frame.time,
            RunMessage::Contacts(contacts) => contacts.time,
            RunMessage::Bonds(bonds) => bonds.time,
            _ => return None,
        };
        let complete = self.take(|frame| frame.time != time);
        match message {
            RunMessage::Frame(frame) => self.frame = Some(frame),
            RunMessage::Contacts(contacts) => self.contacts = Some(contacts),
            RunMessage::Bonds(bonds) => self.bonds = Some(bonds),
            _ => {}
        }
        complete
    }

    /// The last frame, at the end of a run.
    pub fn end(&mut self) -> Option<TimeSlice> {
        self.take(|_| true)
    }

    fn take(&mut self, complete: impl FnOnce(&mut Frame) -> bool) -> Option<TimeSlice> {
        let frame = self.frame.take_if(complete)?;
        let contacts = self.contacts.take().filter(|c| c.time == frame.time);
        let bonds = self.bonds.take().filter(|b| b.time == frame.time);
        Some(TimeSlice { frame, contacts, bonds })
    }
}
