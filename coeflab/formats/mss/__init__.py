"""The Marine Systems Simulator (MSS)."""
