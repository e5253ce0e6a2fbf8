"""The element types, one file for each family. A file lists its types in ``ELEMENTS``; the registry finds every file here."""
