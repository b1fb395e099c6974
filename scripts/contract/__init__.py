"""The contract by its descriptors, and its pages: what scripts/contract_pages.py writes."""
