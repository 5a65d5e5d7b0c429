"""Young's modulus of rubber from its hardness.

Gent (1958), "On the relation between indentation hardness and Young's modulus", Rubber Chemistry and
Technology 31, 896. A durometer of type A presses a truncated cone into the rubber (ASTM D2240): its spring
has 0.55 N at 0 and 8.05 N at 100 degrees, and the cone is pressed in by 0.0254 mm for each degree below 100.
Gent takes it for a flat punch of its mean radius c in an incompressible half-space (Boussinesq), so
F = 8/3 E c d. His numbers in MPa, with 0.137505/0.1 = 8/3 c: c = 0.5156 mm, the mean of the 0.395 mm of the
tip and the 0.635 mm of the shaft.

Relations differ. Ruess' one, lg E = 0.0235 S - 0.6403 from 30 to 60 degrees, has 2 % more at 30, 18 % more at
40 and 63 % more at 60.
"""

from __future__ import annotations

# Degrees of Shore A between which the relation holds within the scatter of measurements; below, the shaft of
# the durometer touches the rubber, and above, its way is shorter than its own error.
LOW, HIGH = 20.0, 80.0


def modulus(shore_a: float) -> float:
    """E [MPa] of Gent's relation at a hardness in degrees of Shore A, below 100."""
    return 0.0981 * (56.0 + 7.62336 * shore_a) / (0.137505 * (254.0 - 2.54 * shore_a))
