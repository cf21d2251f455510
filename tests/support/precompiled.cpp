// Nothing: a source for the target whose precompiled headers all tests share.
