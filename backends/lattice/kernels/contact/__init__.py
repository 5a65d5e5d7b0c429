"""Contacts in a step: near pairs, the slopes of their forces, the condensed contact system, and checks that
no body passes through another."""
