"""The ladder of contact problems with known answers: docs/ladder.md. `problems` wants the standard library alone, `answers` h5py and numpy."""
