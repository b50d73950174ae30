"""The models. A module that has a `FAMILY`, or a list `FAMILIES`, is found by that alone: see `..family`."""
