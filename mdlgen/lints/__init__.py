"""Lints over a Model, by what they are about; `mdlgen.checks` lists them."""
