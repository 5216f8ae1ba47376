//! What input files of Abaqus and others become.
