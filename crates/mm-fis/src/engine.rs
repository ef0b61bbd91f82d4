//! From a system with names to an engine over tables.

use mm_control::fuzzy::{
    self, Consequent, Defuzzifier, FuzzyError, Inference, Mamdani, MamdaniTables, MembershipFunction,
    Operators, Sampling, Sugeno, SugenoOutput, SugenoTables, SugenoVariable,
};

use crate::{Defuzzification, Kind, Shape, System, Variable};

/// How the centroid is found; the other defuzzifications are sampled always, with MATLAB's 101 points under [`Exact`](Self::Exact).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Accuracy {
    /// In closed form; refused with [`FuzzyError::Curved`] where an output set is curved.
    #[default]
    Exact,
    /// By samples.
    Sampled(Sampling),
}

/// An engine of either kind.
#[derive(Debug, Clone, Copy)]
pub enum Engine<'a> {
    /// Rules conclude fuzzy sets.
    Mamdani(Mamdani<'a, f64>),
    /// Rules conclude numbers.
    Sugeno(Sugeno<'a, f64>),
}

impl Engine<'_> {
    /// Number of values that the workspace of [`infer`](Self::infer) needs.
    #[must_use]
    pub const fn workspace_len(&self) -> usize {
        match self {
            Self::Mamdani(engine) => engine.workspace_len(),
            Self::Sugeno(engine) => engine.workspace_len(),
        }
    }

    /// Infers the outputs from the inputs.
    ///
    /// # Errors
    /// As [`Mamdani::infer`].
    pub fn infer(
        &self,
        inputs: &[f64],
        outputs: &mut [f64],
        workspace: &mut [f64],
    ) -> Result<Inference, FuzzyError> {
        match self {
            Self::Mamdani(engine) => engine.infer(inputs, outputs, workspace),
            Self::Sugeno(engine) => engine.infer(inputs, outputs, workspace),
        }
    }
}

impl System {
    /// Makes an engine and hands it to `work`; the engine lives as long as that call.
    ///
    /// Cost: a copy of the tables, then as the engine's own.
    ///
    /// # Errors
    /// As [`Mamdani::try_new`] and [`Sugeno::try_new`]; [`FuzzyError::OutOfRange`] (`outputs.terms`) for a consequent of the
    /// other kind, `defuzzification` for one of the other kind.
    pub fn with_engine<R>(
        &self,
        accuracy: Accuracy,
        work: impl FnOnce(&Engine<'_>) -> R,
    ) -> Result<R, FuzzyError> {
        let sets = |variables: &[Variable]| variables.iter().map(sets_of).collect::<Result<Vec<_>, _>>();
        let input_sets = sets(&self.inputs)?;
        let inputs = joined(&self.inputs, &input_sets);
        let rules: Vec<_> = self.rules.iter().map(borrowed_rule).collect();
        if self.kind == Kind::Mamdani {
            let output_sets = sets(&self.outputs)?;
            let outputs = joined(&self.outputs, &output_sets);
            let (operators, defuzzifier) = (self.operators(), self.defuzzifier(accuracy)?);
            let tables =
                MamdaniTables { inputs: &inputs, outputs: &outputs, rules: &rules, operators, defuzzifier };
            return Ok(work(&Engine::Mamdani(Mamdani::try_new(&tables)?)));
        }
        let consequents = self.outputs.iter().map(consequents_of).collect::<Result<Vec<_>, _>>()?;
        let outputs: Vec<_> = self
            .outputs
            .iter()
            .zip(&consequents)
            .map(|(output, terms)| SugenoVariable { range: output.range, terms })
            .collect();
        let output = match self.defuzzification {
            Defuzzification::WeightedAverage => SugenoOutput::WeightedAverage,
            Defuzzification::WeightedSum => SugenoOutput::WeightedSum,
            _ => return Err(FuzzyError::OutOfRange("defuzzification")),
        };
        let tables = SugenoTables {
            inputs: &inputs,
            outputs: &outputs,
            rules: &rules,
            and: self.and,
            or: self.or,
            output,
        };
        Ok(work(&Engine::Sugeno(Sugeno::try_new(&tables)?)))
    }

    /// The tables of a Mamdani system, stored for the rest of the program, as a control law needs them.
    ///
    /// # Errors
    /// As [`with_engine`](Self::with_engine); [`FuzzyError::OutOfRange`] (`kind`) for a Sugeno system.
    pub fn leak(&self, accuracy: Accuracy) -> Result<&'static MamdaniTables<'static, f64>, FuzzyError> {
        if self.kind != Kind::Mamdani {
            return Err(FuzzyError::OutOfRange("kind"));
        }
        self.with_engine(accuracy, |_| ())?;
        let variables =
            |variables: &[Variable]| -> Result<&'static [fuzzy::Variable<'static, f64>], FuzzyError> {
                let owned = variables.iter().map(|variable| {
                    Ok(fuzzy::Variable { range: variable.range, terms: Vec::leak(sets_of(variable)?) })
                });
                Ok(Vec::leak(owned.collect::<Result<_, _>>()?))
            };
        let rules = self.rules.iter().map(|rule| fuzzy::Rule {
            inputs: Vec::leak(rule.inputs.clone()),
            outputs: Vec::leak(rule.outputs.clone()),
            weight: rule.weight,
            connective: rule.connective,
        });
        Ok(Box::leak(Box::new(MamdaniTables {
            inputs: variables(&self.inputs)?,
            outputs: variables(&self.outputs)?,
            rules: Vec::leak(rules.collect()),
            operators: self.operators(),
            defuzzifier: self.defuzzifier(accuracy)?,
        })))
    }

    /// Whether [`leak`](Self::leak) would make tables: a Mamdani system that an engine takes.
    #[must_use]
    pub fn leaks(&self, accuracy: Accuracy) -> bool {
        self.kind == Kind::Mamdani && self.with_engine(accuracy, |_| ()).is_ok()
    }

    fn operators(&self) -> Operators {
        Operators { and: self.and, or: self.or, implication: self.implication, aggregation: self.aggregation }
    }

    fn defuzzifier(&self, accuracy: Accuracy) -> Result<Defuzzifier, FuzzyError> {
        let sampling = match accuracy {
            Accuracy::Exact => Sampling::default(),
            Accuracy::Sampled(sampling) => sampling,
        };
        Ok(match self.defuzzification {
            Defuzzification::Centroid if accuracy == Accuracy::Exact => Defuzzifier::Centroid,
            Defuzzification::Centroid => Defuzzifier::SampledCentroid(sampling),
            Defuzzification::Bisector => Defuzzifier::Bisector(sampling),
            Defuzzification::MeanOfMaximum => Defuzzifier::MeanOfMaximum(sampling),
            Defuzzification::SmallestOfMaximum => Defuzzifier::SmallestOfMaximum(sampling),
            Defuzzification::LargestOfMaximum => Defuzzifier::LargestOfMaximum(sampling),
            Defuzzification::WeightedAverage | Defuzzification::WeightedSum => {
                return Err(FuzzyError::OutOfRange("defuzzification"));
            }
        })
    }
}

fn sets_of(variable: &Variable) -> Result<Vec<MembershipFunction<f64>>, FuzzyError> {
    let set = |term: &crate::Term| match term.shape {
        Shape::Set(set) => Ok(set),
        Shape::Constant(_) | Shape::Linear(_) => Err(FuzzyError::OutOfRange("outputs.terms")),
    };
    variable.terms.iter().map(set).collect()
}

fn consequents_of(variable: &Variable) -> Result<Vec<Consequent<'_, f64>>, FuzzyError> {
    fn consequent(term: &crate::Term) -> Result<Consequent<'_, f64>, FuzzyError> {
        match &term.shape {
            Shape::Constant(value) => Ok(Consequent::Constant(*value)),
            Shape::Linear(factors) => Ok(Consequent::Linear(factors)),
            Shape::Set(_) => Err(FuzzyError::OutOfRange("outputs.terms")),
        }
    }
    variable.terms.iter().map(consequent).collect()
}

fn joined<'a>(
    variables: &[Variable],
    sets: &'a [Vec<MembershipFunction<f64>>],
) -> Vec<fuzzy::Variable<'a, f64>> {
    variables
        .iter()
        .zip(sets)
        .map(|(variable, terms)| fuzzy::Variable { range: variable.range, terms })
        .collect()
}

fn borrowed_rule(rule: &crate::Rule) -> fuzzy::Rule<'_, f64> {
    fuzzy::Rule {
        inputs: &rule.inputs,
        outputs: &rule.outputs,
        weight: rule.weight,
        connective: rule.connective,
    }
}
