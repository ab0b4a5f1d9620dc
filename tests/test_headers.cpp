// Nothing but its precompiled headers, which all programs of tests use.
