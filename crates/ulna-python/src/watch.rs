//! Long work watched from Python: Ctrl-C is looked for, progress is reported about ten times a second.

use pyo3::prelude::*;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use ulna::monitor::{Monitor, Stage};

/// Asks Python whether to stop, and tells it how far the work is.
pub struct Watch {
    report: Option<Py<PyAny>>,
    state: Mutex<State>,
}

struct State {
    asked: Instant,
    told: Instant,
    failure: Option<PyErr>,
}

/// How long Ctrl-C may wait at the most, where the work asks often enough.
const ASK_EVERY: Duration = Duration::from_millis(50);
const TELL_EVERY: Duration = Duration::from_millis(100);

impl Watch {
    /// With a callable of (stage, done, total), or none.
    pub fn new(report: Option<Py<PyAny>>) -> Watch {
        let now = Instant::now();
        Watch { report, state: Mutex::new(State { asked: now, told: now, failure: None }) }
    }

    /// The exception that stopped the work, if one did.
    pub fn failure(self) -> Option<PyErr> {
        self.state.into_inner().ok().and_then(|state| state.failure)
    }

    fn look(&self, news: Option<(Stage, usize, usize)>) -> bool {
        // another thread is looking already
        let Ok(mut state) = self.state.try_lock() else {
            return true;
        };
        if state.failure.is_some() {
            return false;
        }
        let now = Instant::now();
        let ask = now - state.asked >= ASK_EVERY;
        let tell = news.filter(|_| self.report.is_some() && now - state.told >= TELL_EVERY);
        if !ask && tell.is_none() {
            return true;
        }
        state.asked = now;
        if tell.is_some() {
            state.told = now;
        }
        let answer = Python::attach(|py| {
            if let (Some((stage, done, total)), Some(report)) = (tell, &self.report) {
                report.call1(py, (stage.as_str(), done, total))?;
            }
            py.check_signals()
        });
        match answer {
            Ok(()) => true,
            Err(failure) => {
                state.failure = Some(failure);
                false
            }
        }
    }
}

impl Monitor for Watch {
    fn progress(&self, stage: Stage, done: usize, total: usize) -> bool {
        self.look(Some((stage, done, total)))
    }

    fn keep_going(&self) -> bool {
        self.look(None)
    }
}
