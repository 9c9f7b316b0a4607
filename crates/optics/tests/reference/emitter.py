"""An emitter reflects as `lambert` does."""

from lambert import f

SETS = ["reflectance=0.2,0.5,0.9"]
