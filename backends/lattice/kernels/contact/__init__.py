"""Contacts in a step: which pairs are near, how their forces grow, the condensed contact system, and what a
step may not pass."""
