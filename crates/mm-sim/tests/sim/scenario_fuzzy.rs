//! The fuzzy system of a law: a file or a bundled one, evaluated as a table, by its rules, by samples or in whole numbers.
//!
//! Law: every engine runs the loop to nearly the same tip; a system of the user's own changes the run; one that a law cannot use, or
//! a file that cannot be read, is refused at its place with what would do.
//! Why: what runs on the microcontroller in integers has to be tried in the simulator first, and must not differ from it by surprise.
//! Reference: the run by the rules in floating point.
//! Tolerance: 2 % of the ITAE for whole numbers, which are off by 1e-3 of the largest output at most; 10 % for the table of 65 knots, whose
//! slope at zero, 1.73 instead of 2, makes the loop softer there.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::Folder;
use mm_sim::experiment::Experiment;
use mm_sim::scenario::{self, ScenarioError};
use mm_sim::simulation::{NoRecorder, RunResult};

const TEXT: &str = "name = \"f\"\n[simulation]\nduration_s = 1.0\n[trajectory]\nkind = \"square\"\n[controller]\nkind = \"bfsmc\"\n\
    [[disturbance]]\non = \"joints\"\nshape = \"sine\"\namplitude_n_m = 10.0\nfrequency_rad_s = 20.0\nfrom_s = 0.2\n";

/// Triangles that oppose their input, narrower than those of the default.
const OWN: &str = "[System]\nName='own'\nType='mamdani'\nVersion=2.0\nNumInputs=1\nNumOutputs=1\nNumRules=3\n\
    AndMethod='min'\nOrMethod='max'\nImpMethod='min'\nAggMethod='max'\nDefuzzMethod='centroid'\n\
    [Input1]\nName='s'\nRange=[-1 1]\nNumMFs=3\nMF1='N':'trimf',[-1 -1 0]\nMF2='Z':'trimf',[-1 0 1]\nMF3='P':'trimf',[0 1 1]\n\
    [Output1]\nName='u'\nRange=[-1.5 1.5]\nNumMFs=3\nMF1='N':'trimf',[-1.5 -1 -0.5]\nMF2='Z':'trimf',[-0.5 0 0.5]\n\
    MF3='P':'trimf',[0.5 1 1.5]\n[Rules]\n1, 3 (1) : 1\n2, 2 (1) : 1\n3, 1 (1) : 1\n";

fn run(folder: &Folder, sets: &[&str]) -> Result<RunResult, ScenarioError> {
    folder.write("f.toml", TEXT);
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let loaded = scenario::load(folder.path("f.toml").to_str().expect("text"), &sets)?;
    let experiment = Experiment::build(&loaded)?;
    Ok(experiment.run(&mut NoRecorder).expect("a run"))
}

fn refused(folder: &Folder, sets: &[&str]) -> String {
    match run(folder, sets) {
        Ok(_) => panic!("{sets:?} is taken"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_engine_runs_nearly_the_same_loop() {
    let folder = Folder::new("fuzzy-engines");
    let usual = run(&folder, &[]).expect("a run");
    let table = run(&folder, &["controller.fuzzy_engine=table"]).expect("a run");
    assert_eq!(usual.digest, table.digest, "`table` is the default of `bfsmc`");
    let bundled = run(&folder, &["controller.fis=smooth", "controller.fuzzy_engine=table"]).expect("a run");
    assert_eq!(usual.digest, bundled.digest, "`smooth` is the own system of `bfsmc`");
    let exact = run(&folder, &["controller.fuzzy_engine=exact"]).expect("a run");
    let named = run(&folder, &["controller.fis=smooth"]).expect("a run");
    assert_eq!(exact.digest, named.digest, "`exact` is the default of a system with a name");
    let ratio = usual.metrics.itae_m_s2.sum / exact.metrics.itae_m_s2.sum;
    assert!((ratio - 1.0).abs() < 0.1, "`table` has {ratio} times the ITAE of `exact`");
    for engine in ["q15", "surface"] {
        let other = run(&folder, &[&format!("controller.fuzzy_engine={engine}")]).expect("a run");
        assert_ne!(exact.digest, other.digest, "`{engine}` is `exact`");
        let ratio = other.metrics.itae_m_s2.sum / exact.metrics.itae_m_s2.sum;
        assert!((ratio - 1.0).abs() < 0.02, "`{engine}` has {ratio} times the ITAE of `exact`");
    }
    let sampled = run(&folder, &["controller.fuzzy_engine=sampled"]).expect("a run");
    assert_ne!(usual.digest, sampled.digest, "`sampled` changes nothing");
}

#[test]
fn the_thesis_keeps_its_rules_in_every_engine() {
    let folder = Folder::new("fuzzy-thesis");
    let law = "controller.kind=bfsmc-thesis";
    let usual = run(&folder, &[law]).expect("a run");
    let exact =
        run(&folder, &[law, "controller.fis=thesis", "controller.fuzzy_engine=exact"]).expect("a run");
    assert_eq!(usual.digest, exact.digest, "`exact` is the default of `bfsmc-thesis`");
    for engine in ["q15", "surface"] {
        let other = run(&folder, &[law, &format!("controller.fuzzy_engine={engine}")]).expect("a run");
        // A relay chatters: the paths of two runs part at the first switch, the metrics stay near.
        let ratio = other.metrics.itae_m_s2.sum / usual.metrics.itae_m_s2.sum;
        assert!((ratio - 1.0).abs() < 0.1, "`{engine}` has {ratio} times the ITAE");
    }
}

#[test]
fn a_system_of_the_users_own_changes_the_run() {
    let folder = Folder::new("fuzzy-own");
    folder.write("own.fis", OWN);
    let usual = run(&folder, &[]).expect("a run");
    let path = folder.path("own.fis");
    let own = format!("controller.fis={}", path.display());
    for engine in ["table", "exact", "q15", "surface"] {
        let changed = run(&folder, &[&own, &format!("controller.fuzzy_engine={engine}")]).expect("a run");
        assert_ne!(usual.digest, changed.digest, "`{engine}` of another system gives the same run");
    }
    // An uneven range: the equal steps of a table miss 0, the rules do not.
    folder.write("uneven.fis", &OWN.replace("Range=[-1 1]", "Range=[-1 1.9]").replace("[0 1 1]", "[0 1 3]"));
    let uneven = format!("controller.fis={}", folder.path("uneven.fis").display());
    run(&folder, &[&uneven]).expect("a run by the rules");
    let table = refused(&folder, &[&uneven, "controller.fuzzy_engine=table"]);
    assert!(table.contains("as `table` evaluates it"), "{table}");
    // A law without a fuzzy system takes no notice, so that a comparison can run both.
    let without = run(&folder, &["controller.kind=bsmc"]).expect("a run");
    let with = run(&folder, &["controller.kind=bsmc", &own]).expect("a run");
    assert_eq!(without.digest, with.digest, "`bsmc` has no fuzzy system");
}

#[test]
fn what_cannot_be_used_is_refused_at_its_place() {
    let folder = Folder::new("fuzzy-refused");
    let cases = [
        ("broken.fis", OWN.replace("MF2='Z':'trimf',[-1 0 1]", "MF2='Z':'trimf',[-1 0]"), "broken.fis:18:17"),
        ("aids.fis", OWN.replace("1, 3 (1)", "1, 1 (1)").replace("3, 1 (1)", "3, 3 (1)"), "aids the motion"),
        (
            "two.fis",
            OWN.replace("NumInputs=1", "NumInputs=2")
                .replace(
                    "[Output1]",
                    "[Input2]\nName='b'\nRange=[0 1]\nNumMFs=1\nMF1='A':'trimf',[0 0 1]\n[Output1]",
                )
                .replace("1, 3 (", "1 0, 3 (")
                .replace("2, 2 (", "2 0, 2 (")
                .replace("3, 1 (", "3 0, 1 ("),
            "2 inputs and 1 outputs",
        ),
        (
            "curved.fis",
            OWN.replace("MF2='Z':'trimf',[-0.5 0 0.5]", "MF2='Z':'gaussmf',[0.3 0]"),
            "has to be sampled",
        ),
    ];
    for (name, text, wanted) in &cases {
        folder.write(name, text);
        let set = format!("controller.fis={}", folder.path(name).display());
        let message = refused(&folder, &[&set, "controller.fuzzy_engine=exact"]);
        assert!(message.contains(wanted), "{name}: {message}");
        assert!(message.contains("controller.fis"), "{name} names no key: {message}");
    }
    let curved = format!("controller.fis={}", folder.path("curved.fis").display());
    for engine in ["table", "sampled", "surface"] {
        let taken = run(&folder, &[&curved, &format!("controller.fuzzy_engine={engine}")]);
        assert!(taken.is_ok(), "`{engine}` refuses a curved system: {:?}", taken.err());
    }
    assert!(run(&folder, &[&curved]).is_ok(), "a curved system has no default engine");
    let message = refused(&folder, &["controller.fis=smoth"]);
    assert!(message.contains("cannot read `smoth`") && message.contains("bundled"), "{message}");
    let message = refused(&folder, &["controller.fuzzy_engine=q31"]);
    assert!(message.contains("q15"), "the engines are not listed: {message}");
}
