"""Scenes drawn at random: how many have a result, how many are inaccurate, and why the rest have none."""
