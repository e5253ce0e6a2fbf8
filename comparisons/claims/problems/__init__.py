"""Problems with known answers, each stated once: the manual, the claims of the paper and the tests read them here."""
