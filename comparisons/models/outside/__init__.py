"""Programs of others as models: they run in a child process and answer in JSON."""
