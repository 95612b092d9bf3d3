//! What readings can and cannot determine, in parameters and words.

pub mod causes;
pub mod families;
pub mod identifiability;
