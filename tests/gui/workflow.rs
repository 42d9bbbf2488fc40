//! What an analyst does: open, pick, simulate, scrub.
