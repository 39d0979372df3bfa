"""Fleets with few chargers: who drives what, when and where to charge."""
