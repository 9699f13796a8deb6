//! Tests of loads in closed form.
