"""What the kernels compile to, shipped: how it is made, loaded and called, and what compiles where it does
not fit."""
