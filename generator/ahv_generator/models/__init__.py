"""Parts that families share: any family may import them, one beside its table as well."""
