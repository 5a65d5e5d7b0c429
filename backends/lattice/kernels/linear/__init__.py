"""Systems of linear equations: dense matrices, bands of blocks, what borders and couples them."""
