"""rosbridge v2 for programs such as those of roslib and roslibpy, over the page's server."""
