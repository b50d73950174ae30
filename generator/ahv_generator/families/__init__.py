"""Families that come along; a table names the file, `family = "dcom"`. They are read like a file beside a table."""
