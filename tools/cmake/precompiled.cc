// Nothing: its target exists for the precompiled headers that it makes.
