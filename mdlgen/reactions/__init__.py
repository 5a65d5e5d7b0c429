"""Machines that react, without a solver: readings of sensors, rules that fire, and their orders."""
