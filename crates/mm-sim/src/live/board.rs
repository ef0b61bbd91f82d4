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
    out: Out,
}

/// What the run takes up.
#[derive(Default)]
pub(super) struct Out {
    pub(super) retuned: Option<Box<Retuned>>,
    /// The changes that it is made of, for people.
    pub(super) changes: Vec<String>,
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
                out: Out::default(),
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

    /// Takes what lies there.
    pub(super) fn take(&self) -> Out {
        std::mem::take(&mut self.desk().out)
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
            desk.out.statuses.push(Status::error(error));
        }
        // All of them: what was refused shows again what it was, and some gains follow others.
        desk.out.parameters = desk.values.clone();
        responder.respond(desk.values.clone());
    }
}

impl Desk {
    /// Puts a controller with other gains on the desk; on an error everything stays as it was.
    fn change(&mut self, parameters: Vec<Parameter>) -> Result<(), String> {
        let mut changed = self.changed.clone();
        let mut changes = Vec::new();
        for Parameter { name, value, .. } in parameters {
            let Some(value) = value else { continue };
            if !self.values.iter().any(|served| served.name == name) {
                return Err(format!(
                    "{name} is no gain that acts here and can be changed while a run goes on"
                ));
            }
            let value = tunables::to_toml(&value);
            changes.push(format!("{name} = {value}"));
            changed.insert(name, value);
        }
        let edits = changed.iter().map(|(name, value)| tunables::edit(&self.scenario, name, value));
        let edits: Vec<String> = edits.collect();
        let loaded = self.scenario.edited(&edits).map_err(|error| error.to_string())?;
        let stack = experiment::stack(&loaded).map_err(|error| error.to_string())?;
        let supervised = if self.supervised { experiment::supervised(&loaded).map(Some) } else { Ok(None) };
        let supervised = supervised.map_err(|error| error.to_string())?;
        if stack.acts_as(&self.stack) {
            return Ok(());
        }
        self.values = tunables::refreshed(&self.values, &stack);
        self.stack = stack;
        self.changed = changed;
        self.out.changes.extend(changes);
        self.out.retuned = Some(Box::new(Retuned { stack, supervised }));
        Ok(())
    }
}
