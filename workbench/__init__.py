"""The server: it will show runs in a browser and take commands; it knows neither cognition nor physics."""
