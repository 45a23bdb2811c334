"""Dynamixel X-series driver: tables and codec as data, one bus, one gain mapping."""
