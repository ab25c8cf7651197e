//! Named columns of equal length: what a PLY element and a point cloud message both are.

use thiserror::Error;

/// The numbers of one column, in the type they came in.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Values {
    I8(Vec<i8>),
    U8(Vec<u8>),
    I16(Vec<i16>),
    U16(Vec<u16>),
    I32(Vec<i32>),
    U32(Vec<u32>),
    F32(Vec<f32>),
    F64(Vec<f64>),
}

/// Runs `$body` with `$v` bound to the vector inside, whatever its type.
macro_rules! each {
    ($values:expr, $v:ident => $body:expr) => {
        match $values {
            Values::I8($v) => $body,
            Values::U8($v) => $body,
            Values::I16($v) => $body,
            Values::U16($v) => $body,
            Values::I32($v) => $body,
            Values::U32($v) => $body,
            Values::F32($v) => $body,
            Values::F64($v) => $body,
        }
    };
}
pub(crate) use each;

impl Values {
    /// Number of rows.
    pub fn len(&self) -> usize {
        each!(self, v => v.len())
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value at `row` as `f64` (exact for every type that a column can have).
    pub fn get(&self, row: usize) -> f64 {
        #[allow(clippy::unnecessary_cast)]
        {
            each!(self, v => v[row] as f64)
        }
    }

    /// All values as `f64`, one after the other.
    pub fn iter(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.len()).map(|row| self.get(row))
    }

    /// All values as `f64`.
    pub fn to_f64(&self) -> Vec<f64> {
        #[allow(clippy::unnecessary_cast)]
        {
            each!(self, v => v.iter().map(|&x| x as f64).collect())
        }
    }

    /// The values of the given rows, in that order.
    pub fn select(&self, rows: &[u32]) -> Values {
        macro_rules! pick {
            ($($t:ident),*) => {
                match self { $(Values::$t(v) => Values::$t(rows.iter().map(|&r| v[r as usize]).collect()),)* }
            };
        }
        pick!(I8, U8, I16, U16, I32, U32, F32, F64)
    }

    /// A column of `rows` zeros of the same type.
    pub fn zeros_like(&self, rows: usize) -> Values {
        macro_rules! zeros {
            ($($t:ident),*) => { match self { $(Values::$t(_) => Values::$t(vec![Default::default(); rows]),)* } };
        }
        zeros!(I8, U8, I16, U16, I32, U32, F32, F64)
    }
}

/// A named column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name, as in the file.
    pub name: String,
    /// One value for each row.
    pub values: Values,
}

/// Most columns of a table: names are compared one by one.
pub const MOST_COLUMNS: usize = 4096;

/// Columns of equal length, in the order of the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    columns: Vec<Column>,
    rows: usize,
}

/// What a table refuses.
#[derive(Debug, Error, PartialEq)]
pub enum TableError {
    /// A column of another length.
    #[error("column '{name}' has {len} rows, but the table has {rows}")]
    Length {
        /// The column.
        name: String,
        /// Its rows.
        len: usize,
        /// The table's rows.
        rows: usize,
    },
    /// More columns than a table may have.
    #[error("there are more than {MOST_COLUMNS} columns, up to '{0}': leave out those that are not needed")]
    TooMany(String),
    /// Two columns of one name.
    #[error("two columns have the name '{0}'")]
    Twice(String),
}

impl Table {
    /// A table without columns that has `rows` rows.
    pub fn with_rows(rows: usize) -> Table {
        Table { columns: Vec::new(), rows }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The values of the column called `name`.
    pub fn get(&self, name: &str) -> Option<&Values> {
        self.columns.iter().find(|c| c.name == name).map(|c| &c.values)
    }

    /// Adds a column at the end; the first one of a table made by `default` sets the number of rows.
    ///
    /// # Errors
    /// Another length than the table's, a name that is there already, or a column more than [`MOST_COLUMNS`].
    pub fn push(&mut self, name: &str, values: Values) -> Result<(), TableError> {
        if self.columns.len() >= MOST_COLUMNS {
            return Err(TableError::TooMany(name.to_owned()));
        }
        if self.get(name).is_some() {
            return Err(TableError::Twice(name.to_owned()));
        }
        if self.columns.is_empty() && self.rows == 0 {
            self.rows = values.len();
        }
        if values.len() != self.rows {
            return Err(TableError::Length { name: name.to_owned(), len: values.len(), rows: self.rows });
        }
        self.columns.push(Column { name: name.to_owned(), values });
        Ok(())
    }

    /// Replaces the column called `name` by `values`, or appends it.
    ///
    /// # Errors
    /// Another length than the table's.
    pub fn replace(&mut self, name: &str, values: Values) -> Result<(), TableError> {
        match self.columns.iter().position(|c| c.name == name) {
            Some(_) if values.len() != self.rows => {
                Err(TableError::Length { name: name.to_owned(), len: values.len(), rows: self.rows })
            }
            Some(at) => {
                self.columns[at].values = values;
                Ok(())
            }
            None => self.push(name, values),
        }
    }

    /// Names and values of all columns, in order.
    pub fn into_columns(self) -> impl Iterator<Item = (String, Values)> {
        self.columns.into_iter().map(|column| (column.name, column.values))
    }

    /// Takes the column called `name` out.
    pub fn remove(&mut self, name: &str) -> Option<Values> {
        let at = self.columns.iter().position(|c| c.name == name)?;
        Some(self.columns.remove(at).values)
    }

    /// The given rows of every column, in that order.
    pub fn select(&self, rows: &[u32]) -> Table {
        let pick = |c: &Column| Column { name: c.name.clone(), values: c.values.select(rows) };
        Table { columns: self.columns.iter().map(pick).collect(), rows: rows.len() }
    }
}
