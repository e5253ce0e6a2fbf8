"""How far the solid can be trusted: one question each."""
