"""What goes over the wire, as models: OpenAPI and the page's TypeScript are made from them."""
