"""Many runs of one scene, each with other values: cases, measures, the table, and where the runs are made."""
