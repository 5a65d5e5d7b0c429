"""mdlgen."""
