//! Bakes of small planets.
