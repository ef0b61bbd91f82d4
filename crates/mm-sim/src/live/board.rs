//! What the threads of a server and the run share: who watches, and what they want changed.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use foxglove::websocket::{
    AnyClient, ChannelView, Client, GetParametersResponder, Parameter, ParameterHandler, ServerListener,
    SetParametersResponder, Status,
};

use mm_control::ControlStack;

use super::tunables;
use crate::experiment;
use crate::scenario::Loaded;
use crate::simulation::Retuned;

/// The board on which the server's threads leave what the run takes up at its next sample.
pub(super) struct Board {
    /// Somebody subscribed: what is sent only once has to be sent again.
    newcomer: AtomicBool,
    desk: Mutex<Desk>,
}

struct Desk {
    scenario: Loaded,
    /// Whether the loop has a supervisor.
    supervised: bool,
    /// What was changed so far, by name, as TOML.
    changed: BTreeMap<String, String>,
    /// The controller as it is now, and its gains.
    stack: ControlStack<f64, 3>,
    values: Vec<Parameter>,
    change: Change,
    answer: Answer,
}

/// What the run takes up with its next sample.
#[derive(Default)]
pub(super) struct Change {
    pub(super) retuned: Option<Box<Retuned>>,
    /// What it is made of, for people.
    pub(super) words: Vec<String>,
}

/// What all viewers are to be told, whether the run goes on or not.
#[derive(Default)]
pub(super) struct Answer {
    pub(super) parameters: Vec<Parameter>,
    pub(super) statuses: Vec<Status>,
}

impl Board {
    pub(super) fn new(scenario: Loaded, supervised: bool, stack: ControlStack<f64, 3>) -> Self {
        let values = tunables::of(&scenario, &stack);
        Self {
            newcomer: AtomicBool::new(false),
            desk: Mutex::new(Desk {
                scenario,
                supervised,
                changed: BTreeMap::new(),
                stack,
                values,
                change: Change::default(),
                answer: Answer::default(),
            }),
        }
    }

    /// Whether somebody subscribed since this was last asked.
    pub(super) fn newcomer(&self) -> bool {
        self.newcomer.swap(false, Ordering::Relaxed)
    }

    /// Whether somebody has subscribed; it stays to be asked for.
    pub(super) fn has_watcher(&self) -> bool {
        self.newcomer.load(Ordering::Relaxed)
    }

    /// Takes what the run is to do otherwise.
    pub(super) fn take_change(&self) -> Change {
        std::mem::take(&mut self.desk().change)
    }

    /// Takes what viewers are to be told.
    pub(super) fn take_answer(&self) -> Answer {
        std::mem::take(&mut self.desk().answer)
    }

    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ServerListener for Board {
    fn on_subscribe(&self, _client: Client, _channel: ChannelView<'_>) {
        self.newcomer.store(true, Ordering::Relaxed);
    }
}

impl ParameterHandler for Board {
    fn get(
        &self,
        _client: AnyClient,
        names: Vec<String>,
        _request: Option<String>,
        responder: GetParametersResponder,
    ) {
        let asked_for = |parameter: &&Parameter| names.is_empty() || names.contains(&parameter.name);
        responder.respond(self.desk().values.iter().filter(asked_for).cloned().collect());
    }

    fn set(
        &self,
        _client: AnyClient,
        parameters: Vec<Parameter>,
        _request: Option<String>,
        responder: SetParametersResponder,
    ) {
        let mut desk = self.desk();
        if let Err(error) = desk.change(parameters) {
            desk.answer.statuses.push(Status::error(error));
        }
        // All of them: what was refused shows again what it was, and some gains follow others.
        desk.answer.parameters = desk.values.clone();
        responder.respond(desk.values.clone());
    }
}

impl Desk {
    /// Puts a controller with other gains on the desk; on an error everything stays as it was.
    fn change(&mut self, parameters: Vec<Parameter>) -> Result<(), String> {
        let mut changed = self.changed.clone();
        let mut words = Vec::new();
        for Parameter { name, value, .. } in parameters {
            let Some(value) = value else { continue };
            let Some(served) = self.values.iter().find(|served| served.name == name) else {
                return Err(format!(
                    "{name} is no gain that acts here and can be changed while a run goes on"
                ));
            };
            // A viewer may send all that it shows. A gain that stays as it is goes on following others.
            if served.value.as_ref().is_some_and(|now| tunables::is_same(now, &value)) {
                continue;
            }
            let value = tunables::to_toml(&value);
            words.push(format!("{name} = {value}"));
            changed.insert(name, value);
        }
        let edits = changed.iter().map(|(name, value)| tunables::edit(&self.scenario, name, value));
        let edits: Vec<String> = edits.collect();
        let built = self.scenario.edited(&edits).and_then(|loaded| {
            let supervised = self.supervised.then(|| experiment::supervised(&loaded)).transpose()?;
            Ok((experiment::stack(&loaded)?, supervised))
        });
        let (stack, supervised) = built.map_err(|error| tunables::refusal(&self.scenario, &error))?;
        if stack.acts_as(&self.stack) {
            return Ok(());
        }
        self.values = tunables::refreshed(&self.values, &stack);
        self.stack = stack;
        self.changed = changed;
        self.change.words.extend(words);
        self.change.retuned = Some(Box::new(Retuned { stack, supervised }));
        Ok(())
    }
}
