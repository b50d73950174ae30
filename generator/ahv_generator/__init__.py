"""Derives vehicle models from tables of curve-fitted coefficients with CasADi."""

__version__ = "0.1.0"
