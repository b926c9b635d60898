//! Synthetic gyros as their users see them. One program, to save the linking of many.

mod electronics;
mod json;
mod reproducible;
mod splits;
