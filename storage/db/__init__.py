"""The database: schema, engine, counters, upgrades."""
