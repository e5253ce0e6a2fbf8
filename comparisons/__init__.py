"""One scene through beams, solid elements and exact answers: translation, checks, errors, files, command line."""
