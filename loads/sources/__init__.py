"""Published figures of the source documents, one file of claims per document."""
