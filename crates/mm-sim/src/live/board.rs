//! What the threads of a server and the run share: who watches, and what they want changed.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use foxglove::websocket::{
    AnyClient, ChannelView, Client, GetParametersResponder, Parameter, ParameterHandler, ServerListener,
    SetParametersResponder, Status,
};

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
    /// What was changed so far, by key, as TOML.
    changed: BTreeMap<String, String>,
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
    pub(super) fn new(scenario: Loaded, supervised: bool, values: Vec<Parameter>) -> Self {
        Self {
            newcomer: AtomicBool::new(false),
            desk: Mutex::new(Desk {
                scenario,
                supervised,
                changed: BTreeMap::new(),
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
        let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
        if let Err(error) = desk.change(parameters) {
            desk.out.statuses.push(Status::error(error));
        }
        // Those that were refused show again what they were.
        let now: Vec<_> = desk.values.iter().filter(|value| names.contains(&value.name)).cloned().collect();
        desk.out.parameters.extend(now.iter().cloned());
        responder.respond(now);
    }
}

impl Desk {
    /// Puts a controller with other gains on the desk; on an error everything stays as it was.
    fn change(&mut self, parameters: Vec<Parameter>) -> Result<(), String> {
        let mut changed = self.changed.clone();
        let mut changes = Vec::new();
        for Parameter { name, value, .. } in parameters {
            let Some(value) = value else { continue };
            if !tunables::is_gain(&name) {
                return Err(format!("{name} cannot be changed while a run goes on, gains can"));
            }
            let value = tunables::to_toml(&value);
            changes.push(format!("{name} = {value}"));
            changed.insert(name, value);
        }
        let edits: Vec<String> = changed.iter().map(|(key, value)| format!("{key}={value}")).collect();
        let loaded = self.scenario.edited(&edits).map_err(|error| error.to_string())?;
        let stack = experiment::stack(&loaded).map_err(|error| error.to_string())?;
        let supervised = if self.supervised { experiment::supervised(&loaded).map(Some) } else { Ok(None) };
        let supervised = supervised.map_err(|error| error.to_string())?;
        self.values = tunables::of(&stack);
        self.changed = changed;
        self.out.changes.extend(changes);
        self.out.retuned = Some(Box::new(Retuned { stack, supervised }));
        Ok(())
    }
}
