//! A test on all its specimens: their scenes, their runs, their curves.

use crate::composing::compose::number;
use crate::error::{LabError, Result};
use crate::recipes::{Context, Loading, Part, Prepared, Recipe, Stresses, Value};
use crate::request::{Request, Specimen};
use crate::running::chain::{Chain, Programs, SpecimenFolder, stamp};
use crate::running::specimens::{SpecimenOutcome, Specimens};
use crate::running::warnings::{broke, moves, not_at_rest, not_held, still_rises};
use crate::sample::Sample;
use crate::state;
use crate::summary::{self, Summary};
use geom::Vec3;
use rayon::prelude::*;
use serde_json::Value as Json;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
use std::time::Duration;

/// Between looks at a specimen that another process makes.
const LOOK: Duration = Duration::from_millis(100);

/// A test, ready to run.
pub struct Lab {
    pub(crate) recipe: &'static dyn Recipe,
    pub(crate) sample: Sample,
    pub(crate) request: Request,
    pub(crate) specimen: Specimen,
    pub(crate) loadings: Vec<Loading>,
}

impl Lab {
    /// Checks sample and request, and lays out the specimens.
    ///
    /// # Errors
    /// A sample that the test cannot take, an option that it does not use, a specimen of too few grains.
    pub fn new(recipe: &'static dyn Recipe, sample: Sample, request: Request, seeds: &[u64]) -> Result<Lab> {
        let mut request = request;
        recipe.check(&sample, &request)?;
        let (kind, usual) = recipe.stresses();
        check_repeats(kind, &request.stress)?;
        if request.stress.is_empty() {
            request.stress = usual.to_vec();
        } else if kind == Stresses::None {
            return Err(LabError::Usage(format!(
                "--stress has no effect on {}: leave it out",
                recipe.name()
            )));
        } else if kind == Stresses::Preparation && request.stress.len() > 1 {
            return Err(LabError::Usage(format!(
                "--stress: {} is prepared under one stress: give one",
                recipe.name()
            )));
        }
        if seeds.len() > 1 && !recipe.is_random(&sample) {
            let (name, file) = (recipe.name(), &sample.name);
            return Err(LabError::Usage(format!(
                "--seeds {}: {name} of {file} leaves nothing to chance, because its grains are packed and its bonds all as strong: leave it out",
                seeds.len()
            )));
        }
        let (proportions, share) = recipe.proportions();
        let specimen = {
            let usual = (proportions, share, recipe.grains());
            Specimen::of(&sample, &request, usual, recipe.is_pressed_all_round())?
        };
        let paths: Vec<Vec<f64>> = match kind {
            Stresses::Each => request.stress.iter().map(|stress| vec![*stress]).collect(),
            _ => vec![request.stress.clone()],
        };
        let loading = |path: &Vec<f64>, seed: u64| Loading {
            stress: path.first().copied().unwrap_or(0.0),
            path: path.clone(),
            seed,
        };
        let loadings =
            paths.iter().flat_map(|path| seeds.iter().map(move |seed| loading(path, *seed))).collect();
        let lab = Lab { recipe, sample, request, specimen, loadings };
        for loading in &lab.loadings {
            // At once what can be known before the preparation, which changes height and time step by little.
            let test = recipe.test(&lab.context(loading), &Prepared::default())?;
            lab.refuse_short(&test, lab.sample.grains.step)?;
        }
        Ok(lab)
    }

    /// Refuses a test in which a row has less than a time step [s]; bonds have a step of their own.
    fn refuse_short(&self, test: &Part, step: f64) -> Result<()> {
        if self.sample.has("bond") { Ok(()) } else { self.request.refuse_short(test.until, step) }
    }

    /// The test.
    pub fn recipe(&self) -> &'static dyn Recipe {
        self.recipe
    }

    /// Whether another seed gives another specimen.
    pub fn is_random(&self) -> bool {
        self.recipe.is_random(&self.sample)
    }

    /// Stress and seed of all specimens.
    pub fn loadings(&self) -> &[Loading] {
        &self.loadings
    }

    pub fn sample(&self) -> &Sample {
        &self.sample
    }

    /// The space of each specimen.
    pub fn specimen(&self) -> &Specimen {
        &self.specimen
    }

    pub(crate) fn context<'a>(&'a self, loading: &'a Loading) -> Context<'a> {
        Context { sample: &self.sample, request: &self.request, loading, specimen: &self.specimen }
    }

    /// Name of a specimen, and of its folder.
    pub fn name(&self, loading: &Loading) -> String {
        match self.recipe.stresses().0 {
            Stresses::Each => {
                format!("stress={},seed={}", number(loading.stress).trim_end_matches(".0"), loading.seed)
            }
            _ => format!("seed={}", loading.seed),
        }
    }

    /// Runs all specimens, so many at a time; `begins` is called with the name of each, `ends` after it.
    ///
    /// # Errors
    /// A program that fails, a folder that cannot be written to, a signal. A run that a guard stops is no error: see [`SpecimenOutcome`].
    pub fn run(
        &self,
        folder: &Path,
        programs: &Programs,
        at_once: usize,
        begins: &(dyn Fn(&str) + Sync),
        ends: &(dyn Fn() + Sync),
    ) -> Result<Specimens> {
        let places = self.places(folder, programs)?;
        places.iter().try_for_each(SpecimenFolder::check)?;
        let finished = AtomicUsize::new(0);
        let one = |(loading, place): (&Loading, &SpecimenFolder), wait: bool| {
            let outcome = self.one(loading, place, programs, (begins, wait))?;
            finished.fetch_add(usize::from(outcome.is_some()), SeqCst);
            outcome.iter().for_each(|_| ends());
            Ok(outcome)
        };
        // Each thread waits for the programs of one specimen.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(at_once).build()?;
        let all = || self.loadings.par_iter().zip(&places).with_max_len(1);
        let made: Result<Vec<Option<SpecimenOutcome>>> = pool.install(|| {
            let first: Vec<_> = all().map(|of| one(of, false)).collect::<Result<_>>()?;
            // Then those that another process has begun.
            all()
                .zip(first)
                .map(|(of, made)| made.map_or_else(|| one(of, true), |made| Ok(Some(made))))
                .collect()
        });
        if (programs.stop)() || matches!(made, Err(LabError::Interrupted)) {
            return Err(LabError::Signal { done: finished.into_inner(), all: self.loadings.len() });
        }
        let outcomes = made?.into_iter().map(|made| made.ok_or(LabError::Interrupted));
        let list = self.loadings.iter().cloned().zip(outcomes).map(|(loading, made)| Ok((loading, made?)));
        Ok(Specimens { list: list.collect::<Result<_>>()? })
    }

    /// The specimens that are not finished in a folder.
    ///
    /// # Errors
    /// A file of the sample or a program that cannot be read; a folder where another process makes other specimens.
    pub fn open(&self, folder: &Path, programs: &Programs) -> Result<Vec<&Loading>> {
        let places = self.places(folder, programs)?;
        places.iter().try_for_each(SpecimenFolder::check)?;
        let open = self.loadings.iter().zip(places).filter(|(_, place)| !place.is_finished());
        Ok(open.map(|(loading, _)| loading).collect())
    }

    /// Where each specimen lies.
    fn places(&self, folder: &Path, programs: &Programs) -> Result<Vec<SpecimenFolder>> {
        // Stresses are those of each loading: a specimen is the same among others.
        let request = Request { stress: Vec::new(), ..self.request.clone() };
        let asked = format!("{}\n{request:?}", self.recipe.name());
        let made_from = stamp(&asked, &self.sample.files, &programs.folder)? + &self.sample.compose().text();
        let place = |loading: &Loading| {
            let specimen = self.name(loading);
            let stamp = stream::sha256(format!("{made_from}{loading:?}").as_bytes());
            SpecimenFolder { folder: folder.join(&specimen), specimen, stamp }
        };
        Ok(self.loadings.iter().map(place).collect())
    }

    /// One specimen from its preparation to its curve; `None`: another process makes it, unless this one is to wait for that.
    fn one(
        &self,
        loading: &Loading,
        place: &SpecimenFolder,
        programs: &Programs,
        (begins, wait): (&(dyn Fn(&str) + Sync), bool),
    ) -> Result<Option<SpecimenOutcome>> {
        let chain = loop {
            if (programs.stop)() {
                return Err(LabError::Interrupted);
            }
            match place.take(programs)? {
                Some(chain) => break chain,
                None if !wait => return Ok(None),
                None => {
                    begins(&format!("{}, which another process makes", place.specimen));
                    std::thread::sleep(LOOK);
                }
            }
        };
        begins(&place.specimen);
        chain.begin()?;
        let outcome = match self.tested(loading, &chain) {
            Err(stopped @ LabError::Stopped { cause, .. }) => {
                SpecimenOutcome::Stopped { why: stopped.to_string(), cause }
            }
            other => other?,
        };
        chain.finish()?;
        Ok(Some(outcome))
    }

    fn tested(&self, loading: &Loading, chain: &Chain) -> Result<SpecimenOutcome> {
        let of = self.context(loading);
        let (mut warnings, mut prepared, mut step) = (Vec::new(), Prepared::default(), 0.0);
        let preparation = self.recipe.preparation(&of)?;
        if let Some(part) = &preparation {
            let scene = self.compose_preparation(&of, part, self.sample.compose_in(&chain.place.folder));
            let report = self.simulate("prepare", &scene, part, chain)?;
            warnings.extend(not_at_rest(&report));
            step = report["dt"].as_f64().unwrap_or(0.0);
            warnings.extend(moves((&self.sample, &self.specimen), loading, chain)?);
            warnings.extend(broke(&self.sample, part, chain)?);
            for wall in self.recipe.placed() {
                let table = chain.measure(
                    "prepare",
                    &format!("prepared-{wall}.csv"),
                    &["--wall-force", "all", "--instants", "--wall", wall],
                )?;
                let last = |column: &str| -> Result<f64> {
                    Ok(table.column(column)?.last().copied().unwrap_or(0.0))
                };
                let shift = Vec3::new(last("shift_x")?, last("shift_y")?, last("shift_z")?);
                prepared.shifts.insert((*wall).to_owned(), shift);
            }
        }
        let part = self.recipe.test(&of, &prepared)?;
        self.refuse_short(&part, step)?;
        let scene =
            self.compose_test(&of, &part, preparation.is_some(), self.sample.compose_in(&chain.place.folder));
        let report = self.simulate("test", &scene, &part, chain)?;
        warnings.extend(not_held(&report));
        let named = [self.recipe.tables(&of, &prepared), state::tables(self.recipe, &of)].concat();
        let tables = chain.tables(&named)?;
        let curve = self.recipe.curve(&of, &prepared, &tables)?;
        let states = state::states(self.recipe, &of, &prepared, &tables, &curve)?;
        let curve = state::joined(curve, &states);
        let moments = Box::new(state::moments(self.recipe, &curve, &states));
        let values = self.recipe.values(&of, &curve);
        warnings.extend(still_rises(&curve));
        warnings.extend(self.recipe.warnings(&of, &curve));
        Ok(SpecimenOutcome::Tested { curve, values, moments, warnings })
    }

    fn simulate(&self, name: &str, scene: &str, part: &Part, chain: &Chain) -> Result<Json> {
        chain.write(&format!("{name}.toml"), scene)?;
        part.files.iter().try_for_each(|(file, text)| chain.write(file, text))?;
        chain.dem_run(name)
    }

    /// The specimens that a guard has stopped, and why.
    pub fn stopped(&self, specimens: &Specimens) -> Vec<String> {
        let why = |(loading, outcome): &(Loading, SpecimenOutcome)| match outcome {
            SpecimenOutcome::Stopped { why, .. } => Some(format!("{}: {why}", self.name(loading))),
            SpecimenOutcome::Tested { .. } => None,
        };
        specimens.list.iter().filter_map(why).collect()
    }

    /// What all curves come to.
    pub fn summary(&self, specimens: &Specimens) -> Summary {
        let values = |stress: f64| -> Vec<Vec<Value>> {
            let of = specimens.list.iter().filter(|(loading, _)| loading.stress == stress);
            of.map(|(_, outcome)| match outcome {
                SpecimenOutcome::Tested { values, .. } => values.clone(),
                SpecimenOutcome::Stopped { .. } => Vec::new(),
            })
            .collect()
        };
        let mut stresses: Vec<f64> = self.loadings.iter().map(|loading| loading.stress).collect();
        stresses.dedup();
        let shown = |stress: f64| (self.recipe.stresses().0 == Stresses::Each).then_some(stress);
        let levels: Vec<_> =
            stresses.iter().map(|stress| summary::level(shown(*stress), &values(*stress))).collect();
        let envelope = self.recipe.envelope().map_or(Vec::new(), |kind| summary::envelope(kind, &levels));
        let strengths =
            levels.iter().flat_map(|level| &level.figures).find(|figure| figure.name == "strength");
        let weibull = strengths.filter(|_| self.recipe.name() == "crush").map_or(Vec::new(), |figure| {
            summary::weibull_figures(&figure.values.iter().flatten().copied().collect::<Vec<f64>>())
        });
        Summary { levels, envelope, weibull }
    }
}

/// Refuses a specimen that would be counted twice, and a step of a path that goes nowhere.
fn check_repeats(kind: Stresses, all: &[f64]) -> Result<()> {
    let again = match kind {
        Stresses::Each => (1..all.len()).find(|&k| all[..k].contains(&all[k])),
        _ => (1..all.len()).find(|&k| all[k - 1] == all[k]),
    };
    again.map_or(Ok(()), |k| {
        let stress = geom::Shown(all[k]);
        Err(LabError::Usage(format!("--stress: {stress} Pa is given twice: leave one of them out")))
    })
}

/// The folder of programs: that of this one.
///
/// # Errors
/// A system that does not tell.
pub fn beside_this_program() -> Result<PathBuf> {
    let file = std::env::current_exe();
    let file = file.map_err(LabError::file("lab-test", "cannot find out where this program is"))?;
    Ok(file.parent().unwrap_or(Path::new(".")).to_owned())
}
