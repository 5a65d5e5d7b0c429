"""Rubber covers of rollers: modulus from hardness, the bonded layer, and the nip that it makes."""
