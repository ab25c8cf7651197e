//! What the columns of the tables mean.

/// A column of the table of parameters (CSV).
pub(super) struct Column {
    pub name: &'static str,
    pub means: &'static str,
}

const fn column(name: &'static str, means: &'static str) -> Column {
    Column { name, means }
}

/// All columns, in their order.
pub(super) const COLUMNS: [Column; 16] = [
    column("parameter", "name"),
    column("unit", "unit of the parameter"),
    column("value", "median of what the data and the priors allow"),
    column("low", "lower end of the interval"),
    column("high", "upper end of the interval"),
    column(
        "best",
        "value at the best point: where the emulator expects the least misfit, its own uncertainty counted; the nearest trial where a run of that point is worse than predicted",
    ),
    column("prior_low", "lower end of the interval before the tests"),
    column("prior_high", "upper end of the interval before the tests"),
    column("width_over_prior", "width of the interval over that before the tests"),
    column("influence", "largest total sensitivity (Sobol index) of a test to the parameter"),
    column("determined", "whether the interval is narrower than 0.85 of that before the tests"),
    column("step", "the step that found it"),
    column(
        "misfit_predicted",
        "square of the misfit that the emulator expects of a run of its best point, in deviations of the data",
    ),
    column("misfit_simulated", "that of the run of this point; empty: there was none"),
    column("misfit_expected", "that of the true parameters: points less parameters, and the scatter of runs"),
    column(
        "fits",
        "whether a run is within three standard deviations of what is expected of the true parameters",
    ),
];

/// Explanations of the columns, a line each.
pub(super) fn columns() -> impl Iterator<Item = (&'static str, &'static str)> {
    COLUMNS.iter().map(|c| (c.name, c.means))
}
