"""The API of the page: what is told and asked by HTTP."""
