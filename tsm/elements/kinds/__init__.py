"""The element types, one family a file: each file states its types as ``ELEMENTS``, and a new file is found by itself."""
