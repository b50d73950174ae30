"""Parts that come along: each file has one, which joins a model by the names of its inputs and states."""
