"""The shipped compiled kernels: how they are made, loaded and called, and the compiler that is used where
they do not fit."""
