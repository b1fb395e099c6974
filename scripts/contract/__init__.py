"""The contract by its descriptors: no generated code."""
