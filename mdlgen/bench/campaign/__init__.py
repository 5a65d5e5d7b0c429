"""A campaign runs scenes that are drawn at random, and counts results, inaccurate results and failures."""
