"""What another program recorded of the same scene: its files, and how far a run is from them."""
