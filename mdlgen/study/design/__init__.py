"""What a study asks: values that differ, cases, and what is measured of each."""
