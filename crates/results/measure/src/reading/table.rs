//! Columns of a message, with errors that name what is missing or wrong.

use crate::MeasureError;
use geom::Vec3;
use stream::Table;

/// No component of a vector is as large as this: squares of it still are numbers.
const FAR: f64 = 1e100;

/// A message of points, where it came from.
pub(crate) struct Columns<'a> {
    pub topic: &'a str,
    pub time: f64,
    pub table: &'a Table,
}

impl Columns<'_> {
    /// The column; its numbers must be finite.
    pub(crate) fn numbers(&self, column: &str) -> Result<Vec<f64>, MeasureError> {
        let Some(values) = self.table.get(column) else {
            let has = names(self.table);
            let (topic, column) = (self.topic.to_owned(), column.to_owned());
            return Err(MeasureError::Column { topic, column, has });
        };
        let values = values.to_f64();
        self.check(column, &values, f64::is_finite, "not finite")?;
        Ok(values)
    }

    /// The column; zeros when there is none.
    pub(crate) fn or_zero(&self, column: &str) -> Result<Vec<f64>, MeasureError> {
        match self.table.get(column) {
            Some(_) => self.numbers(column),
            None => Ok(vec![0.0; self.table.rows()]),
        }
    }

    /// The column; its numbers must be above zero.
    pub(crate) fn positive(&self, column: &str) -> Result<Vec<f64>, MeasureError> {
        let values = self.numbers(column)?;
        self.check(column, &values, |v| v > 0.0, "not above 0")?;
        self.check(column, &values, |v| v < FAR, "too large")?;
        Ok(values)
    }

    /// Three columns as vectors.
    pub(crate) fn vectors(&self, columns: [&str; 3]) -> Result<Vec<Vec3>, MeasureError> {
        let [x, y, z] = columns.map(|c| {
            let values = self.numbers(c)?;
            self.check(c, &values, |v| v.abs() < FAR, "too large")?;
            Ok(values)
        });
        Ok(x?.into_iter().zip(y?).zip(z?).map(|((x, y), z)| Vec3::new(x, y, z)).collect())
    }

    /// Whole numbers, such as ids.
    pub(crate) fn whole(&self, column: &str) -> Result<Vec<u64>, MeasureError> {
        let values = self.numbers(column)?;
        self.check(column, &values, |v| v >= 0.0 && v.fract() == 0.0, "no whole number")?;
        Ok(values.into_iter().map(|v| v as u64).collect())
    }

    fn check(
        &self,
        column: &str,
        values: &[f64],
        good: impl Fn(f64) -> bool,
        wrong: &'static str,
    ) -> Result<(), MeasureError> {
        match values.iter().enumerate().find(|(_, v)| !good(**v)) {
            None => Ok(()),
            Some((row, value)) => Err(MeasureError::Value {
                topic: self.topic.to_owned(),
                time: self.time,
                row,
                column: column.to_owned(),
                value: *value,
                wrong,
            }),
        }
    }
}

/// Names of the columns of a table.
pub(crate) fn names(table: &Table) -> Vec<String> {
    table.columns().iter().map(|c| c.name.clone()).collect()
}
