//! Values of Python as the values of a problem file, and JSON as values of Python.
//!
//! | Python | problem file |
//! |---|---|
//! | bool, int, float, str, and numpy's scalars | the same |
//! | list, tuple, numpy's arrays | a list |
//! | dict | a table |
//! | a path (`os.PathLike`) | a text |
//! | None as a value of a dict | the key is left out |

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyNone, PyString, PyTuple};
use serde_json::Value as Json;
use toml::{Table, Value};

/// The deepest nesting of lists and tables.
const DEEPEST: usize = 32;

/// Returns a dict of Python as a table; keys whose value is None are left out.
///
/// # Errors
/// `TypeError` for a key that is no text, and for a value that no problem file can hold.
pub fn table(dict: &Bound<'_, PyAny>) -> PyResult<Table> {
    match value(dict, "", 0)? {
        Some(Value::Table(table)) => Ok(table),
        _ => Err(unfit(dict, "")),
    }
}

/// Returns a value as TOML text: the value of an override.
///
/// # Errors
/// As [`table`].
pub fn text(object: &Bound<'_, PyAny>, key: &str) -> PyResult<String> {
    match value(object, key, 0)? {
        Some(Value::String(text)) => Ok(text),
        Some(value) => Ok(value.to_string()),
        None => Err(unfit(object, key)),
    }
}

fn value(object: &Bound<'_, PyAny>, key: &str, depth: usize) -> PyResult<Option<Value>> {
    let inside = |part: &str| if key.is_empty() { part.to_owned() } else { format!("{key}.{part}") };
    if depth > DEEPEST {
        return Err(PyTypeError::new_err(format!("{key}: lists are nested too deeply")));
    }
    if object.is_instance_of::<PyNone>() {
        return Ok(None);
    }
    // A bool is an int of Python's.
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(Some(Value::Boolean(flag.is_true())));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Some(Value::Float(object.extract()?)));
    }
    if object.is_instance_of::<PyInt>() {
        let whole = object.extract::<i64>();
        return whole.map(|n| Some(Value::Integer(n))).map_err(|_| {
            PyTypeError::new_err(format!("{key}: {object} is beyond the whole numbers of a problem file"))
        });
    }
    if object.is_instance_of::<PyString>() {
        return Ok(Some(Value::String(object.extract()?)));
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let mut list = Vec::with_capacity(object.len()?);
        for (i, item) in object.try_iter()?.enumerate() {
            let key = inside(&i.to_string());
            let item = item?;
            list.push(value(&item, &key, depth + 1)?.ok_or_else(|| unfit(&item, &key))?);
        }
        return Ok(Some(Value::Array(list)));
    }
    if let Ok(mapping) = object.cast::<PyMapping>() {
        let mut table = Table::new();
        for pair in mapping.items()?.iter() {
            let (name, item): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.extract()?;
            let name: String = name.extract().map_err(|_| {
                PyTypeError::new_err(format!("{}: a key is a text, not {}", inside("?"), kind(&name)))
            })?;
            if let Some(value) = value(&item, &inside(&name), depth + 1)? {
                table.insert(name, value);
            }
        }
        return Ok(Some(Value::Table(table)));
    }
    // Arrays and scalars of numpy, and what else knows how it is written in Python's own types.
    if let Ok(plain) = object.call_method0("tolist")
        && !plain.is(object)
    {
        return value(&plain, key, depth + 1);
    }
    if let Ok(path) = object.call_method0("__fspath__") {
        return value(&path, key, depth + 1);
    }
    Err(unfit(object, key))
}

fn kind(object: &Bound<'_, PyAny>) -> String {
    object.get_type().name().map_or_else(|_| "that".into(), |name| name.to_string())
}

fn unfit(object: &Bound<'_, PyAny>, key: &str) -> PyErr {
    let place = if key.is_empty() { String::new() } else { format!("{key}: ") };
    let kind = kind(object);
    PyTypeError::new_err(format!(
        "{place}a problem holds numbers, texts, true and false, lists and dicts of them; this is of type {kind}"
    ))
}

/// Returns JSON as values of Python.
///
/// # Errors
/// Those of Python.
pub fn to_python<'py>(py: Python<'py>, json: &Json) -> PyResult<Bound<'py, PyAny>> {
    Ok(match json {
        Json::Null => py.None().into_bound(py),
        Json::Bool(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Json::Number(number) => match (number.as_i64(), number.as_u64()) {
            (Some(whole), _) => whole.into_pyobject(py)?.into_any(),
            (_, Some(whole)) => whole.into_pyobject(py)?.into_any(),
            _ => number.as_f64().unwrap_or(f64::NAN).into_pyobject(py)?.into_any(),
        },
        Json::String(text) => PyString::new(py, text).into_any(),
        Json::Array(list) => {
            let list = list.iter().map(|item| to_python(py, item)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, list)?.into_any()
        }
        Json::Object(map) => {
            let dict = PyDict::new(py);
            for (name, item) in map {
                dict.set_item(name, to_python(py, item)?)?;
            }
            dict.into_any()
        }
    })
}

/// Returns data as values of Python.
///
/// # Errors
/// Those of Python, and of data that JSON cannot hold.
pub fn data<'py>(py: Python<'py>, data: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let json = serde_json::to_value(data).map_err(crate::errors::refused)?;
    to_python(py, &json)
}
