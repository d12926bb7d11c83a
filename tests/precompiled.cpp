// Empty: its target owns the precompiled header that the programs share.
