"""From a request to verified files: read, derive, emit, verify, publish."""
