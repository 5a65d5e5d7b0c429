"""What a run leaves, the same whichever solver ran."""
